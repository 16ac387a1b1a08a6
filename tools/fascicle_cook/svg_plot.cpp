#include "tools/fascicle_cook/svg_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace fascicle::cook {
namespace {

constexpr const char* kGrid = "stroke=\"#e3e5e8\" stroke-width=\"1\"";

std::string escape(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      default: result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

// That tell one tick from the next.
int decimals_of(double step) { return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9); }

struct Range {
  double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();

  void add(std::span<const double> values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
};

// Where a value of a logarithmic chart stands: not finite where it has no place.
std::vector<double> powers_of(std::vector<double> values) {
  for (double& value : values) value = value > 0.0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
  return values;
}

Chart with_powers(Chart chart) {
  for (ChartLine& line : chart.lines) line.values = powers_of(std::move(line.values));
  if (chart.band) {
    chart.band->lower = powers_of(std::move(chart.band->lower));
    chart.band->upper = powers_of(std::move(chart.band->upper));
  }
  return chart;
}

// All of the chart's values with a little room.
Range range_of(const Chart& chart) {
  Range range;
  for (const ChartLine& line : chart.lines) range.add(line.values);
  if (chart.band) {
    range.add(chart.band->lower);
    range.add(chart.band->upper);
  }
  if (range.least > range.most) range = {0.0, 1.0};
  // Values that are all alike, too, need an axis with a length.
  const double least = std::max({chart.least_range, 1e-6 * std::abs(range.most), 1e-9});
  const double room = std::max(0.04 * (range.most - range.least), 0.5 * (least - (range.most - range.least)));
  return {range.least - room, range.most + room};
}

std::size_t steps_of(std::span<const Chart> charts) {
  std::size_t steps = 2;
  for (const Chart& chart : charts) {
    for (const ChartLine& line : chart.lines) steps = std::max(steps, line.values.size());
  }
  return steps;
}

void draw_line(Svg& svg, const Panel& panel, const ChartLine& line) {
  const std::string style = fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:.1f}\" stroke-linejoin=\"round\"",
                                        line.colour, line.width);
  std::vector<glm::dvec2> points;
  const auto finish = [&] {
    svg.path(points, false, style);
    points.clear();
  };
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (std::isfinite(line.values[i])) {
      points.emplace_back(panel.x(static_cast<double>(i + 1)), panel.y(line.values[i]));
    } else {
      finish();
    }
  }
  finish();
}

void draw_band(Svg& svg, const Panel& panel, const ChartBand& band) {
  std::vector<glm::dvec2> points;
  const std::size_t count = std::min(band.lower.size(), band.upper.size());
  const auto add = [&](std::size_t i, double value) {
    if (std::isfinite(value)) points.emplace_back(panel.x(static_cast<double>(i + 1)), panel.y(value));
  };
  for (std::size_t i = 0; i < count; ++i) add(i, band.upper[i]);
  for (std::size_t i = count; i-- > 0;) add(i, band.lower[i]);
  svg.path(points, true, fmt::format("fill=\"{}\" fill-opacity=\"0.22\"", band.colour));
}

void draw_legend(Svg& svg, double x, double y, const Chart& chart) {
  const auto name = [&](const std::string& words) {
    svg.text(x + 26, y + 4.5, 13, "start", words);
    x += 50.0 + 7.3 * static_cast<double>(words.size());
  };
  if (chart.band) {
    svg.box(x, y - 6, 20, 12, fmt::format("fill=\"{}\" fill-opacity=\"0.22\"", chart.band->colour).c_str());
    name(chart.band->name);
  }
  for (const ChartLine& line : chart.lines) {
    if (line.name.empty()) continue;
    svg.line(x, y, x + 20, y, fmt::format("stroke=\"{}\" stroke-width=\"2.5\"", line.colour).c_str());
    name(line.name);
  }
}

}  // namespace

Svg::Svg(double width, double height) {
  text_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
      width, height);
}

void Svg::text(double x, double y, int size, const char* anchor, const std::string& words, const char* colour,
               const char* more) {
  text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" ", x, y, size);
  text_ += fmt::format("text-anchor=\"{}\" fill=\"{}\"{}>", anchor, colour, more);
  text_ += escape(words) + "</text>\n";
}

void Svg::turned_text(double x, double y, int size, const std::string& words) {
  text(x, y, size, "middle", words, "#222222", fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y).c_str());
}

void Svg::line(double x0, double y0, double x1, double y1, const char* style) {
  text_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0, x1, y1, style);
}

void Svg::box(double x, double y, double width, double height, const char* style) {
  text_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x, y, width, height,
                       style);
}

void Svg::circle(double x, double y, double radius, const std::string& style) {
  text_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", x, y, radius, style);
}

void Svg::path(std::span<const glm::dvec2> points, bool closed, const std::string& style) {
  if (points.empty()) return;
  text_ += "<path d=\"";
  glm::dvec2 last = points[0];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && i + 1 < points.size() && glm::distance(points[i], last) < 0.5) continue;
    text_ += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', points[i].x, points[i].y);
    last = points[i];
  }
  text_ += fmt::format("{}\" {}/>\n", closed ? "Z" : "", style);
}

double tick_step(double range, double most) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range <= most * factor * power) return factor * power;
  }
  return 10.0 * power;
}

void draw_frame(Svg& svg, const Panel& panel, double step_x, double step_y, const char* x_label, const char* y_label) {
  const auto steps = [](double from, double to, double step, auto&& each) {
    for (double i = std::ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; i += 1.0) each(i * step);
  };
  const double bottom = panel.top + panel.height, right = panel.left + panel.width;
  steps(panel.x0, panel.x1, step_x, [&](double value) {
    svg.line(panel.x(value), panel.top, panel.x(value), bottom, kGrid);
    svg.line(panel.x(value), bottom, panel.x(value), bottom + 5, kAxisStyle);
    svg.text(panel.x(value), bottom + 21, 13, "middle", fmt::format("{:.{}f}", value + 0.0, decimals_of(step_x)));
  });
  steps(panel.y0, panel.y1, step_y, [&](double value) {
    svg.line(panel.left, panel.y(value), right, panel.y(value), kGrid);
    svg.line(panel.left - 5, panel.y(value), panel.left, panel.y(value), kAxisStyle);
    const std::string label = panel.logarithmic ? fmt::format("1e{:.0f}", value + 0.0)
                                                : fmt::format("{:.{}f}", value + 0.0, decimals_of(step_y));
    svg.text(panel.left - 9, panel.y(value) + 4.5, 13, "end", label);
  });
  svg.box(panel.left, panel.top, panel.width, panel.height, "fill=\"none\" stroke=\"#444444\" stroke-width=\"1.2\"");
  svg.text(panel.left + 0.5 * panel.width, bottom + 45, 15, "middle", x_label);
  svg.turned_text(panel.left - 66, panel.top + 0.5 * panel.height, 15, y_label);
}

std::string draw_charts(const std::string& title, const std::string& subtitle, std::span<const Chart> charts,
                        const char* x_label) {
  constexpr double kWidth = 820, kHeight = 300, kTop = 120, kBelow = 100;
  Svg svg(kWidth + 150, kTop + static_cast<double>(charts.size()) * (kHeight + kBelow) - 25);
  svg.text(40, 42, 21, "start", title, "#111111", " font-weight=\"bold\"");
  svg.text(40, 68, 14, "start", subtitle, "#444444");
  const auto steps = static_cast<double>(steps_of(charts));
  double top = kTop;
  for (const Chart& given : charts) {
    const Chart chart = given.logarithmic ? with_powers(given) : given;
    const Range range = range_of(chart);
    const Panel panel{110, top, kWidth, kHeight, 0.0, steps, range.least, range.most, chart.logarithmic};
    const double step_y = tick_step(range.most - range.least, 7.0);
    draw_frame(svg, panel, std::max(tick_step(steps, 12.0), 1.0), chart.logarithmic ? std::max(step_y, 1.0) : step_y,
               x_label, chart.y_label.c_str());
    if (chart.band) draw_band(svg, panel, *chart.band);
    for (const ChartLine& line : chart.lines) draw_line(svg, panel, line);
    draw_legend(svg, panel.left, top - 18, chart);
    top += kHeight + kBelow;
  }
  return svg.finish();
}

}  // namespace fascicle::cook
