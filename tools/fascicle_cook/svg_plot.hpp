// Pictures of figures as SVG: primitives in pixels, frames with ticks, and line charts over a run's steps.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace fascicle::cook {

class Svg {
 public:
  Svg(double width, double height);

  void text(double x, double y, int size, const char* anchor, const std::string& words, const char* colour = "#222222",
            const char* more = "");
  void turned_text(double x, double y, int size, const std::string& words);
  void line(double x0, double y0, double x1, double y1, const char* style);
  void box(double x, double y, double width, double height, const char* style);
  void circle(double x, double y, double radius, const std::string& style);
  // Points closer than half a pixel to the one before are left out.
  void path(std::span<const glm::dvec2> points, bool closed, const std::string& style);
  std::string finish() { return std::move(text_) + "</svg>\n"; }

 private:
  std::string text_;
};

inline constexpr const char* kAxisStyle = "stroke=\"#444444\" stroke-width=\"1.2\"";

// A rectangle of the picture (pixels, y down) and the values at its sides.
struct Panel {
  double left, top, width, height;
  double x0, x1, y0, y1;
  bool logarithmic = false;  // y0 and y1 are powers of ten, and so are the ticks' labels

  double x(double value) const { return left + (value - x0) / (x1 - x0) * width; }
  double y(double value) const { return top + height - (value - y0) / (y1 - y0) * height; }
};

// 1, 2 or 5 times a power of ten, so that `range` has at most `most` of them.
double tick_step(double range, double most);

// The panel's border, grid, ticks and labels.
void draw_frame(Svg& svg, const Panel& panel, double step_x, double step_y, const char* x_label, const char* y_label);

struct ChartLine {
  std::string name;            // in the legend; empty: not there
  std::string colour;
  double width = 1.8;          // pixels
  std::vector<double> values;  // by step, from 1; those that are not finite leave a gap
};

// The room between two lines, filled.
struct ChartBand {
  std::string name, colour;
  std::vector<double> lower, upper;
};

struct Chart {
  std::string y_label;
  std::vector<ChartLine> lines;
  std::optional<ChartBand> band;
  double least_range = 0.0;  // the y axis spans no less; of a logarithmic one, in powers of ten
  bool logarithmic = false;  // values that are not positive leave a gap, too
};

// Charts over the same steps, one below the other.
std::string draw_charts(const std::string& title, const std::string& subtitle, std::span<const Chart> charts,
                        const char* x_label = "step");

}  // namespace fascicle::cook
