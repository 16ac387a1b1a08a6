#include "engine/animation/motion_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/animation/joint_model.hpp"
#include "engine/content/file_text.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kMostErrors = 50;      // a file with more is wrong as a whole
constexpr double kLargestValue = 1e6;        // rad, m, degrees or s
constexpr double kShortestStep = 1e-9;       // s

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < 12; ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > 12) text += fmt::format(" and {} more", names.size() - 12);
  return text;
}

struct Field {
  std::string_view text;
  int column = 1;
};

std::vector<Field> split_fields(std::string_view line) {
  std::vector<Field> fields;
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && is_space(line[at])) ++at;
    const std::size_t begin = at;
    while (at < line.size() && !is_space(line[at])) ++at;
    if (at > begin) fields.push_back({line.substr(begin, at - begin), static_cast<int>(begin) + 1});
  }
  return fields;
}

// "/jointset/hip_r/hip_flexion_r/value" -> "hip_flexion_r"; empty for a path to anything else than a value.
std::string_view coordinate_of_column(std::string_view column) {
  if (column.empty() || column.front() != '/') return column;
  const std::string_view suffix = "/value";
  if (column.size() < suffix.size() || column.substr(column.size() - suffix.size()) != suffix) return {};
  column.remove_suffix(suffix.size());
  return column.substr(column.rfind('/') + 1);
}

class MotionParser {
 public:
  MotionParser(std::string_view text, const std::string& file, const JointModel& model)
      : rest_(text), file_(file), model_(model) {}

  Result<Motion> parse() {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
    if (!read_header() || !read_columns()) return std::move(diagnostics_);
    read_rows();
    if (!diagnostics_.ok()) return std::move(diagnostics_);
    check_counts();
    finish_motion(motion_, model_);
    return Result<Motion>(std::move(motion_), std::move(diagnostics_));
  }

 private:
  bool next_line(std::string_view& line) {
    if (rest_.empty()) return false;
    ++line_;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }

  void error(int line, int column, std::string path, std::string cause, std::string remedy) {
    diagnostics_.errors.push_back({file_, line, column, std::move(path), std::move(cause), std::move(remedy)});
  }
  void warn(int line, std::string cause, std::string remedy) {
    diagnostics_.warnings.push_back({file_, line, line > 0 ? 1 : 0, {}, std::move(cause), std::move(remedy)});
  }

  std::optional<std::int64_t> header_count(const std::string& key) const {
    const auto found = header_.find(key);
    if (found == header_.end()) return std::nullopt;
    std::int64_t value = 0;
    const std::string& text = found->second;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  bool read_header() {
    std::string_view line;
    bool ended = false;
    while (!ended && next_line(line)) {
      line = trimmed(line);
      ended = lower(line) == "endheader";
      if (motion_.name.empty() && line_ == 1 && line.find('=') == std::string_view::npos)
        motion_.name = std::string(line);
      if (const std::size_t equals = line.find('='); equals != std::string_view::npos) {
        header_[lower(trimmed(line.substr(0, equals)))] = std::string(trimmed(line.substr(equals + 1)));
      }
    }
    if (!ended) {
      error(1, 1, {}, "this is not an OpenSim motion: no line `endheader`",
            "give a .mot or .sto file whose header ends with `endheader`");
      return false;
    }
    if (const auto type = header_.find("datatype"); type != header_.end() && lower(type->second) != "double") {
      error(line_, 1, {}, fmt::format("DataType is {}", type->second),
            "give a table of plain numbers (DataType=double)");
      return false;
    }
    const auto degrees = header_.find("indegrees");
    if (degrees == header_.end()) {
      warn(line_, "the header does not say inDegrees; the angles are taken as radians",
           "add a line inDegrees=yes or inDegrees=no before endheader");
    } else if (lower(degrees->second) == "yes" || lower(degrees->second) == "no") {
      in_degrees_ = lower(degrees->second) == "yes";
    } else {
      error(line_, 1, {}, fmt::format("inDegrees is '{}'", degrees->second), "write inDegrees=yes or inDegrees=no");
    }
    return true;
  }

  bool read_columns() {
    std::string_view line;
    std::vector<Field> fields;
    while (fields.empty() && next_line(line)) fields = split_fields(line);
    if (fields.empty()) {
      error(line_, 1, {}, "no line of column names after endheader", "add it: time, then the coordinates' names");
      return false;
    }
    if (lower(fields[0].text) != "time") {
      error(line_, fields[0].column, {}, fmt::format("the first column is '{}'", fields[0].text),
            "let the first column be time (s)");
    }
    column_line_ = line_;
    std::map<std::string_view, int> seen;
    std::vector<std::string> unknown;
    std::vector<bool> driven(model_.coordinates.size(), false);
    for (const Field& field : fields) {
      columns_.emplace_back(field.text);
      targets_.push_back(-1);
      const auto [first, fresh] = seen.emplace(field.text, field.column);
      if (!fresh) {
        error(line_, field.column, {}, fmt::format("the column '{}' occurs twice", field.text), "remove one of them");
        continue;
      }
      if (columns_.size() == 1) continue;
      const std::string_view name = coordinate_of_column(field.text);
      if (name.empty()) continue;
      const std::int32_t coordinate = model_.find_coordinate(name);
      if (coordinate < 0) {
        unknown.emplace_back(field.text);
      } else if (driven[static_cast<std::size_t>(coordinate)]) {
        error(line_, field.column, {}, fmt::format("two columns give the coordinate '{}'", name), "remove one of them");
      } else {
        driven[static_cast<std::size_t>(coordinate)] = true;
        targets_.back() = coordinate;
      }
    }
    if (std::none_of(driven.begin(), driven.end(), [](bool is) { return is; })) {
      std::vector<std::string> known;
      for (const JointCoordinate& coordinate : model_.coordinates) known.push_back(coordinate.name);
      error(line_, 1, {}, "no column is a coordinate of the model", "the model's coordinates are: " + joined(known));
      return false;
    }
    if (!unknown.empty()) {
      warn(line_, "columns that the model does not know are left out: " + joined(unknown),
           "check their names if they matter");
    }
    report_missing(driven);
    return true;
  }

  void report_missing(const std::vector<bool>& driven) {
    std::vector<std::string> missing;
    for (std::size_t c = 0; c < driven.size(); ++c) {
      const JointCoordinate& coordinate = model_.coordinates[c];
      if (!driven[c] && !coordinate.locked && coordinate.driver < 0) missing.push_back(coordinate.name);
    }
    if (!missing.empty()) {
      warn(line_, "coordinates without a column keep their defaults: " + joined(missing),
           "add columns if they should move");
    }
  }

  void read_rows() {
    motion_.coordinates = model_.coordinates.size();
    std::string_view line;
    while (next_line(line)) {
      const std::vector<Field> fields = split_fields(line);
      if (fields.empty()) continue;
      if (diagnostics_.errors.size() >= kMostErrors) {
        error(line_, 1, {}, "too many errors, the rest is not read", "mend the ones above first");
        return;
      }
      ++rows_;
      read_row(fields);
    }
    if (rows_ == 0) error(line_, 1, {}, "the motion has no rows", "give at least one sample");
  }

  void read_row(const std::vector<Field>& fields) {
    const std::string path = fmt::format("row {}", rows_);
    if (fields.size() != columns_.size()) {
      error(line_, 1, path,
            fmt::format("{} values, but line {} names {} columns", fields.size(), column_line_, columns_.size()),
            "give one value a column");
      return;
    }
    std::vector<double> row(motion_.coordinates);
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = model_.coordinates[c].default_value;
    double time = 0.0;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      std::string_view text = fields[f].text;
      if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
      double value = 0.0;
      const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (code != std::errc{} || end != text.data() + text.size() || !(std::abs(value) <= kLargestValue)) {
        error(line_, fields[f].column, fmt::format("{}, column {}", path, columns_[f]),
              fmt::format("'{}' is not a finite number within 1e6", fields[f].text.substr(0, 40)),
              "replace or interpolate it");
        return;
      }
      if (f == 0) time = value;
      if (targets_[f] < 0) continue;
      const auto target = static_cast<std::size_t>(targets_[f]);
      const bool angle = model_.coordinates[target].kind == JointCoordinate::Kind::kRotation;
      row[target] = in_degrees_ && angle ? value * (std::numbers::pi / 180.0) : value;
    }
    if (!motion_.times.empty() && time - motion_.times.back() < kShortestStep) {
      error(line_, fields[0].column, path,
            fmt::format("the time {} does not rise above the one before, {}", time, motion_.times.back()),
            "sort the rows by time and remove doubles");
      return;
    }
    motion_.times.push_back(time);
    motion_.values.insert(motion_.values.end(), row.begin(), row.end());
  }

  void check_counts() {
    const auto check = [&](const std::string& key, const char* label, std::size_t found, const char* what) {
      const auto stated = header_count(key);
      if (!stated || *stated == static_cast<std::int64_t>(found)) return;
      warn(1, fmt::format("the header says {}={}, but there are {} {}", label, *stated, found, what),
           "correct the header, or see whether the file is cut short");
    };
    check("nrows", "nRows", rows_, "rows");
    check("ncolumns", "nColumns", columns_.size(), "columns");
  }

  std::string_view rest_;
  const std::string& file_;
  const JointModel& model_;
  int line_ = 0;
  int column_line_ = 0;
  std::size_t rows_ = 0;
  bool in_degrees_ = false;
  std::map<std::string, std::string> header_;  // names in lower case
  std::vector<std::string> columns_;
  std::vector<std::int32_t> targets_;          // by column: the coordinate, or -1
  Motion motion_;
  Diagnostics diagnostics_;
};

}  // namespace

Result<Motion> read_motion(const std::filesystem::path& file, const JointModel& model) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.diagnostics();
  return parse_motion(*text, file.string(), model);
}

Result<Motion> parse_motion(std::string_view text, const std::string& file_name, const JointModel& model) {
  return MotionParser(text, file_name, model).parse();
}

}  // namespace fascicle
