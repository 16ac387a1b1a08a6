// Suggestions for misspelt names: "did you mean".
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fascicle {

// The candidate with the fewest edits (insert, delete, replace, swap of neighbours, case counts half) from `name`, the
// first of several; empty where none is near enough to be a likely slip.
std::string_view closest_name(std::string_view name, std::span<const std::string_view> candidates);
std::string_view closest_name(std::string_view name, std::span<const std::string> candidates);

// A remedy for an unknown name: "did you mean 'X'?" where one is close, else "known KIND: A, B, C, ..." (at most
// twelve).
std::string suggest_name(std::string_view name, std::span<const std::string_view> candidates, std::string_view kind);
std::string suggest_name(std::string_view name, std::span<const std::string> candidates, std::string_view kind);

}  // namespace fascicle
