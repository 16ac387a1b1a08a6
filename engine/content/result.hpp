// How readers answer. Bad content is not exceptional: a reader returns Result<T>, which holds either a value or
// every error it found in the file, each with its place, cause and remedy, plus warnings in both cases.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fascicle {

// One fault in a content file. `line` and `column` count from 1; 0 means that the format has no such position.
struct Diagnostic {
  std::string file;
  int line = 0;
  int column = 0;
  std::string path;    // place inside the document: a JSON pointer, an XML element path, a glTF accessor
  std::string cause;   // what is wrong, with the offending value
  std::string remedy;  // what would be right
};

// "file:line:column: path: cause; remedy", leaving out the parts that are empty.
std::string to_string(const Diagnostic& diagnostic);

struct Diagnostics {
  std::vector<Diagnostic> errors;
  std::vector<Diagnostic> warnings;

  bool ok() const { return errors.empty(); }
  void append(Diagnostics other);
};

// Errors and warnings as text, one a line; or as JSON:
// {"errors": [{file, line, column, path, cause, remedy}], "warnings": [...]}.
std::string to_text(const Diagnostics& diagnostics);
std::string to_json(const Diagnostics& diagnostics);

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value, Diagnostics diagnostics = {}) : value_(std::move(value)), diagnostics_(std::move(diagnostics)) {
    assert(diagnostics_.ok());
  }
  Result(Diagnostics diagnostics) : diagnostics_(std::move(diagnostics)) { assert(!diagnostics_.ok()); }
  Result(Diagnostic error) { diagnostics_.errors.push_back(std::move(error)); }

  bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }
  T& value() { assert(ok()); return *value_; }
  const T& value() const { assert(ok()); return *value_; }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  std::optional<T> value_;
  Diagnostics diagnostics_;
};

}  // namespace fascicle
