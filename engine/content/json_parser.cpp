// A strict recursive-descent parser (RFC 8259). It stops at the first syntax error, because what follows one is
// guesswork; duplicate names and numbers too large for a double are collected, and parsing goes on.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/content/json_tree.hpp"
#include "engine/content/limit_errors.hpp"

namespace fascicle::detail {
namespace {

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxErrors = 100;
constexpr std::size_t kMaxValues = std::size_t{1} << 24;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$'; }

// Length of the valid UTF-8 sequence at `text[at]` (RFC 3629), 0 when there is none.
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0u) == 0x80u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    const unsigned second = byte(1);
    if (first == 0xe0 && second < 0xa0) return 0;  // overlong
    if (first == 0xed && second > 0x9f) return 0;  // surrogate
    return follows(1) && follows(2) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const unsigned second = byte(1);
    if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) return 0;
    return follows(1) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

void append_utf8(std::string& out, std::uint32_t code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    out += static_cast<char>(0xf0 | (code >> 18));
    out += static_cast<char>(0x80 | ((code >> 12) & 0x3f));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  }
}

class Parser {
 public:
  Parser(JsonTree& tree, Diagnostics& diagnostics) : tree_(tree), text_(tree.text), diagnostics_(diagnostics) {}

  bool parse() {
    if (!check_encoding()) return false;
    skip_space();
    if (at_ == text_.size()) return fail(0, "the file is empty", "write a JSON document, such as { }");
    if (!parse_value(kNoJson)) return false;
    skip_space();
    if (at_ < text_.size()) {
      return fail(at_, fmt::format("{} after the end of the document", found()),
                  "remove it; a file holds one JSON value");
    }
    return true;
  }

 private:
  bool fail(std::size_t offset, std::string cause, std::string remedy) {
    diagnostics_.errors.push_back(tree_.diagnostic(open_, offset, std::move(cause), std::move(remedy)));
    return false;
  }

  bool check_encoding() {
    if (text_.starts_with("\xef\xbb\xbf")) {
      return fail(0, "the file starts with a byte order mark", "save it as UTF-8 without BOM");
    }
    for (std::size_t i = 0; i < text_.size();) {
      const std::size_t length = utf8_length(text_, i);
      if (length == 0) {
        return fail(i, fmt::format("byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text_[i])),
                    "save the file as UTF-8; is it a text file?");
      }
      i += length;
    }
    return true;
  }

  void skip_space() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) {
      ++at_;
    }
  }

  // What stands at the current place, for messages.
  std::string found() const {
    if (at_ >= text_.size()) return "the end of the file";
    std::size_t length = 0;
    while (at_ + length < text_.size() && is_word(text_[at_ + length]) && length < 24) ++length;
    if (length == 0) length = utf8_length(text_, at_);
    const std::string_view token = text_.substr(at_, length);
    if (static_cast<unsigned char>(token[0]) < 0x20) return fmt::format("character {}", static_cast<int>(token[0]));
    return fmt::format("'{}'", token);
  }

  bool at_comment() const {
    return at_ + 1 < text_.size() && text_[at_] == '/' && (text_[at_ + 1] == '/' || text_[at_ + 1] == '*');
  }
  bool fail_comment() { return fail(at_, "a comment", "JSON has no comments: remove it"); }

  std::uint32_t add_value(std::uint32_t parent) {
    const auto index = static_cast<std::uint32_t>(tree_.values.size());
    JsonValue value;
    value.parent = parent;
    value.begin = static_cast<std::uint32_t>(at_);
    if (parent != kNoJson) value.index = tree_.values[parent].child_count++;
    tree_.values.push_back(value);
    return index;
  }

  // Parses the value at the current place as the last child of `parent`.
  bool parse_value(std::uint32_t parent) {
    skip_space();
    if (tree_.values.size() == kMaxValues) {
      return fail(at_, fmt::format("more than {} values", kMaxValues), "split the file; is it the right one?");
    }
    const std::uint32_t value = add_value(parent);
    if (parent != kNoJson) {
      std::uint32_t& link =
          last_child_ == kNoJson ? tree_.values[parent].first_child : tree_.values[last_child_].next_sibling;
      link = value;
      tree_.values[value].key = pending_key_;
      tree_.values[value].key_begin = pending_key_begin_;
    }
    const bool ok = parse_content(value);
    tree_.values[value].end = static_cast<std::uint32_t>(at_);
    last_child_ = value;
    return ok;
  }

  bool parse_content(std::uint32_t value) {
    if (at_ == text_.size()) return fail_end();
    const char c = text_[at_];
    if (c == '{' || c == '[') return parse_container(value, c == '{');
    if (c == '"') {
      std::string string;
      if (!parse_string(string)) return false;
      tree_.values[value].kind = JsonKind::kString;
      tree_.values[value].string = add_string(std::move(string));
      return true;
    }
    if (is_digit(c) || c == '-') return parse_number(value);
    return parse_word(value);
  }

  bool fail_end() {
    if (open_ == kNoJson) return fail(at_, "the file ends where a value is wanted", "write the value");
    const JsonValue& container = tree_.values[open_];
    const bool object = container.kind == JsonKind::kObject;
    const TextPosition start = tree_.lines.position(text_, container.begin);
    return fail(at_,
                fmt::format("the file ends inside the {} that starts at {}:{}", object ? "object" : "array", start.line,
                            start.column),
                fmt::format("is it cut off? Close it with '{}'", object ? '}' : ']'));
  }

  bool parse_word(std::uint32_t value) {
    std::size_t length = 0;
    while (at_ + length < text_.size() && is_word(text_[at_ + length])) ++length;
    const std::string_view word = text_.substr(at_, length);
    JsonValue& out = tree_.values[value];
    if (word == "true" || word == "false") {
      out.kind = JsonKind::kBoolean;
      out.boolean = word == "true";
    } else if (word == "null") {
      out.kind = JsonKind::kNull;
    } else {
      return fail_value(word);
    }
    at_ += length;
    return true;
  }

  bool fail_value(std::string_view word) {
    if (at_comment()) return fail_comment();
    const char c = text_[at_];
    if (word == "NaN" || word == "nan" || word == "Infinity" || word == "inf" || word == "Inf" || word == "INF") {
      return fail(at_, fmt::format("{} is not a number in JSON", word), "write a finite number");
    }
    if (c == '\'') return fail(at_, "a string in single quotes", "use double quotes");
    if (c == '+' || c == '.')
      return fail(at_, fmt::format("a number starts with '{}'", c), "write it as in 0.5 or 1e-3");
    if ((c == ']' || c == '}') && last_was_comma_)
      return fail(at_, fmt::format("a comma stands before '{}'", c), "remove the comma");
    if (!word.empty())
      return fail(at_, fmt::format("{} where a value is wanted", found()), "strings stand in double quotes");
    return fail(at_, fmt::format("{} where a value is wanted", found()),
                "write a number, string, array, object, true, false or null");
  }

  bool parse_number(std::uint32_t value) {
    const std::size_t begin = at_;
    const auto digits = [&] {
      const std::size_t first = at_;
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
      return at_ - first;
    };
    const auto bad = [&](std::string_view why, std::string_view remedy) {
      while (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '.' || text_[at_] == '+' || text_[at_] == '-'))
        ++at_;
      return fail(begin, fmt::format("'{}' {}", text_.substr(begin, std::min<std::size_t>(at_ - begin, 32)), why),
                  std::string(remedy));
    };
    if (text_[at_] == '-') ++at_;
    const bool zero = at_ < text_.size() && text_[at_] == '0';
    const std::size_t whole = digits();
    if (whole == 0) return bad("is not a number", "write a finite number, such as -0.5");
    if (zero && whole > 1) return bad("has a leading zero", "remove the zero");
    if (at_ < text_.size() && text_[at_] == '.') {
      ++at_;
      if (digits() == 0) return bad("has no digits after the point", "write it as in 1.0");
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      if (digits() == 0) return bad("has no digits in its exponent", "write it as in 1e-3");
    }
    if (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '.'))
      return bad("is not a number", "write a finite number");
    JsonValue& out = tree_.values[value];
    out.kind = JsonKind::kNumber;
    const auto [end, code] = std::from_chars(text_.data() + begin, text_.data() + at_, out.number);
    if (code == std::errc::result_out_of_range) {
      // Both overflow and underflow come here; a number that underflows is zero.
      out.number = 0.0;
      if (overflows(text_.substr(begin, at_ - begin)) && has_room(diagnostics_.errors, kMaxErrors, tree_.file)) {
        diagnostics_.errors.push_back(tree_.diagnostic(
            value, begin,
            fmt::format("{} is too large for a number", text_.substr(begin, std::min<std::size_t>(at_ - begin, 32))),
            "write a number below 1e308"));
      }
    }
    return true;
  }

  // Whether a number that from_chars found out of range is too large rather than too small: its first digit that is not
  // zero stands at a power of ten above or below zero.
  static bool overflows(std::string_view number) {
    const std::size_t e = std::min(number.find_first_of("eE"), number.size());
    long exponent = 0;
    if (e < number.size()) {
      std::string_view digits = number.substr(e + 1);
      if (digits.starts_with('+')) digits.remove_prefix(1);
      if (std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec ==
          std::errc::result_out_of_range) {
        exponent = digits.starts_with('-') ? -1000000000L : 1000000000L;
      }
    }
    const std::string_view mantissa = number.substr(0, e);
    const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
    const std::size_t first = mantissa.find_first_of("123456789");
    if (first == std::string_view::npos) return false;
    return exponent + point - static_cast<long>(first) > 0;
  }

  std::uint32_t add_string(std::string string) {
    tree_.strings.push_back(std::move(string));
    return static_cast<std::uint32_t>(tree_.strings.size() - 1);
  }

  std::optional<std::uint32_t> parse_hex4() {
    if (at_ + 4 > text_.size()) return std::nullopt;
    std::uint32_t code = 0;
    const char* end = text_.data() + at_ + 4;
    if (std::from_chars(text_.data() + at_, end, code, 16).ptr != end) return std::nullopt;
    at_ += 4;
    return code;
  }

  bool parse_string(std::string& out) {
    const std::size_t begin = at_++;
    while (at_ < text_.size() && text_[at_] != '"') {
      const char c = text_[at_];
      if (static_cast<unsigned char>(c) < 0x20) {
        if (c == '\n' || c == '\r')
          return fail(begin, "a string without its closing quote on the line", "close it with \", or write \\n");
        return fail(at_, fmt::format("control character {} in a string", static_cast<int>(c)),
                    fmt::format("write it as \\u{:04x}", static_cast<int>(c)));
      }
      if (c != '\\') {
        out += c;
        ++at_;
      } else if (!parse_escape(out)) {
        return false;
      }
    }
    if (at_ == text_.size()) return fail(begin, "the file ends inside a string", "is it cut off? Close it with \"");
    ++at_;
    return true;
  }

  bool parse_escape(std::string& out) {
    const std::size_t begin = at_++;
    const char c = at_ < text_.size() ? text_[at_++] : '\0';
    constexpr std::string_view kLetters = "\"\\/bfnrt";
    constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
    if (const std::size_t i = kLetters.find(c); i != std::string_view::npos) {
      out += kMeanings[i];
      return true;
    }
    if (c != 'u') return fail(begin, "an unknown escape in a string", "write a backslash as \\\\");
    std::optional<std::uint32_t> code = parse_hex4();
    if (code && *code >= 0xd800 && *code < 0xdc00 && text_.substr(at_).starts_with("\\u")) {
      at_ += 2;
      const std::optional<std::uint32_t> low = parse_hex4();
      code = low && *low >= 0xdc00 && *low < 0xe000
                 ? std::optional(0x10000 + ((*code - 0xd800) << 10) + (*low - 0xdc00))
                 : std::nullopt;
    }
    if (!code || (*code >= 0xd800 && *code < 0xe000)) {
      return fail(begin, "a \\u escape that is no character", "write four hexadecimal digits, or the character itself");
    }
    if (*code == 0) return fail(begin, "character 0 in a string", "remove it");
    append_utf8(out, *code);
    return true;
  }

  bool parse_container(std::uint32_t value, bool object) {
    const char close = object ? '}' : ']';
    tree_.values[value].kind = object ? JsonKind::kObject : JsonKind::kArray;
    if (++depth_ > kMaxDepth)
      return fail(at_, fmt::format("nested deeper than {} levels", kMaxDepth), "flatten it; is it the right file?");
    const std::uint32_t outer = std::exchange(open_, value);
    last_child_ = kNoJson;
    ++at_;
    skip_space();
    last_was_comma_ = false;
    if (at_ < text_.size() && text_[at_] == close) {
      ++at_;
    } else if (!parse_children(value, object, close)) {
      return false;
    }
    if (object) report_duplicates(value);
    open_ = outer;
    --depth_;
    return true;
  }

  bool parse_children(std::uint32_t value, bool object, char close) {
    for (std::uint32_t before = kNoJson;;) {
      if (object && !parse_key(close)) return false;
      if (!object) pending_key_ = kNoJson;
      last_child_ = before;
      if (!parse_value(value)) return false;
      before = last_child_;
      skip_space();
      if (at_ == text_.size()) return fail_end();
      last_was_comma_ = text_[at_] == ',';
      if (text_[at_] == close) {
        ++at_;
        return true;
      }
      if (!last_was_comma_) {
        if (at_comment()) return fail_comment();
        return fail(at_, fmt::format("{} where ',' or '{}' is wanted", found(), close),
                    "is a comma missing before it?");
      }
      ++at_;
      skip_space();
    }
  }

  bool parse_key(char close) {
    if (at_ == text_.size()) return fail_end();
    if (at_comment()) return fail_comment();
    if (text_[at_] == close && last_was_comma_) return fail(at_, "a comma stands before '}'", "remove the comma");
    if (text_[at_] != '"')
      return fail(at_, fmt::format("{} where a member's name is wanted", found()), "write the name in double quotes");
    const std::size_t begin = at_;
    std::string name;
    if (!parse_string(name)) return false;
    skip_space();
    if (at_ == text_.size()) return fail_end();
    if (text_[at_] != ':')
      return fail(at_, fmt::format("{} after the name \"{}\"", found(), name), "write ':' and the value");
    ++at_;
    pending_key_ = add_string(std::move(name));
    pending_key_begin_ = static_cast<std::uint32_t>(begin);
    return true;
  }

  void report_duplicates(std::uint32_t object) {
    std::vector<std::uint32_t> children;
    for (std::uint32_t c = tree_.values[object].first_child; c != kNoJson; c = tree_.values[c].next_sibling)
      children.push_back(c);
    const auto name = [&](std::uint32_t c) -> const std::string& { return tree_.strings[tree_.values[c].key]; };
    std::ranges::sort(children, [&](auto a, auto b) {
      return std::pair(std::string_view(name(a)), a) < std::pair(std::string_view(name(b)), b);
    });
    for (std::size_t i = 1; i < children.size(); ++i) {
      if (name(children[i]) != name(children[i - 1])) continue;
      if (!has_room(diagnostics_.errors, kMaxErrors, tree_.file)) continue;
      const TextPosition first = tree_.lines.position(text_, tree_.values[children[i - 1]].key_begin);
      diagnostics_.errors.push_back(tree_.diagnostic(
          children[i], tree_.values[children[i]].key_begin,
          fmt::format("'{}' stands twice, first at {}:{}", name(children[i]), first.line, first.column),
          "remove one of them"));
    }
  }

  JsonTree& tree_;
  std::string_view text_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::uint32_t open_ = kNoJson;        // innermost open container
  std::uint32_t last_child_ = kNoJson;  // the sibling before the value to come
  std::uint32_t pending_key_ = kNoJson;
  std::uint32_t pending_key_begin_ = 0;
  bool last_was_comma_ = false;
};

}  // namespace

bool parse_json_tree(JsonTree& tree, Diagnostics& diagnostics) { return Parser(tree, diagnostics).parse(); }

}  // namespace fascicle::detail
