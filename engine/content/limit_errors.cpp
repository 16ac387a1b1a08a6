#include "engine/content/limit_errors.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace fascicle {
namespace {

// What an entry that stands for others says: its cause begins with their count.
constexpr std::string_view kCause = " more are left out";
constexpr std::string_view kRemedy = "mend those above, then check again";

// How many others an entry stands for; 0 for one that describes itself.
std::size_t left_out(const Diagnostic& entry) {
  if (entry.remedy != kRemedy || !entry.cause.ends_with(kCause)) return 0;
  std::size_t count = 0;
  std::from_chars(entry.cause.data(), entry.cause.data() + entry.cause.size(), count);
  return count;
}

}  // namespace

bool has_room(std::vector<Diagnostic>& list, std::size_t limit, const std::string& file) {
  if (list.size() < limit) return true;
  const std::size_t before = list.empty() ? 0 : left_out(list.back());
  if (before == 0) list.push_back({file, 0, 0, {}, {}, std::string(kRemedy)});
  list.back().cause = fmt::format("{}{}", before + 1, kCause);
  return false;
}

std::size_t count_with_left_out(const std::vector<Diagnostic>& list) {
  std::size_t count = 0;
  for (const Diagnostic& entry : list) {
    const std::size_t others = left_out(entry);
    count += others == 0 ? 1 : others;
  }
  return count;
}

}  // namespace fascicle
