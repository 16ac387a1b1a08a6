#include "engine/content/closest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

namespace fascicle {
namespace {

constexpr std::size_t kMaxListed = 12;
constexpr std::size_t kMaxNameLength = 128;  // longer names are no slips, and the table grows with the square

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

// Optimal string alignment distance in half edits: a change of case costs 1, every other edit 2.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = 2 * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = 2 * static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = a[i - 1] == b[j - 1] ? 0 : lower(a[i - 1]) == lower(b[j - 1]) ? 1 : 2;
      next[j] = std::min({row[j] + 2, next[j - 1] + 2, row[j - 1] + replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 2);
    }
    std::swap(before, row);
    std::swap(row, next);
  }
  return row[b.size()];
}

template <class Name>
std::string_view find_closest(std::string_view name, std::span<const Name> candidates) {
  if (name.size() > kMaxNameLength) return {};
  std::string_view best;
  int best_distance = std::numeric_limits<int>::max();
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > kMaxNameLength) continue;
    const int distance = edit_distance(name, candidate);
    // A third of the letters may be wrong, at least one edit: more is another name.
    const int allowed = std::max(2, 2 * static_cast<int>(std::max(name.size(), candidate.size()) / 3));
    const bool near = distance <= allowed || equal_but_for_case(name, candidate);
    if (near && distance < best_distance && distance < 2 * static_cast<int>(candidate.size())) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

template <class Name>
std::string suggest(std::string_view name, std::span<const Name> candidates, std::string_view kind) {
  const std::string_view close = find_closest(name, candidates);
  if (!close.empty()) return fmt::format("did you mean '{}'?", close);
  if (candidates.empty()) return fmt::format("there are no {}", kind);
  std::string text = fmt::format("known {}: ", kind);
  for (std::size_t i = 0; i < std::min(candidates.size(), kMaxListed); ++i) {
    if (i > 0) text += ", ";
    text += std::string_view(candidates[i]);
  }
  if (candidates.size() > kMaxListed) text += fmt::format(" and {} more", candidates.size() - kMaxListed);
  return text;
}

}  // namespace

std::string_view closest_name(std::string_view name, std::span<const std::string_view> candidates) {
  return find_closest(name, candidates);
}
std::string_view closest_name(std::string_view name, std::span<const std::string> candidates) {
  return find_closest(name, candidates);
}
std::string suggest_name(std::string_view name, std::span<const std::string_view> candidates, std::string_view kind) {
  return suggest(name, candidates, kind);
}
std::string suggest_name(std::string_view name, std::span<const std::string> candidates, std::string_view kind) {
  return suggest(name, candidates, kind);
}

}  // namespace fascicle
