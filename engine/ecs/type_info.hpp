// Identity and printable name of a component or resource type, without RTTI. A type is identified by the address of
// its TypeInfo (so that two types of the same name in two anonymous namespaces stay apart); everything that has an
// order goes by name, which is the same in every run and build. TypeTable maps types to values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace fascicle::ecs {

struct TypeInfo {
  std::string_view full_name;  // fascicle::muscle::ActionLine
  std::string_view name;       // ActionLine
  std::uint64_t hash = 0;      // of full_name
};

using TypeId = const TypeInfo*;

namespace detail {

// The compiler's own spelling: "... [T = fascicle::A]" (Clang) or "... [with T = fascicle::A; ...]" (GCC).
template <class T>
constexpr std::string_view parse_type_name() {
  std::string_view text = __PRETTY_FUNCTION__;
  const std::size_t begin = text.find("T = ") + 4;
  std::size_t end = begin;
  for (int depth = 0; end < text.size(); ++end) {
    const char c = text[end];
    if (c == '<' || c == '(' || c == '[' || c == '{') ++depth;
    if (depth == 0 && (c == ';' || c == ']')) break;
    if (c == '>' || c == ')' || c == ']' || c == '}') --depth;
  }
  return text.substr(begin, end - begin);
}

// Drops the namespaces in front, not those inside template arguments.
constexpr std::string_view without_namespaces(std::string_view name) {
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    const char c = name[i];
    if (c == '<' || c == '(' || c == '{') ++depth;
    if (c == '>' || c == ')' || c == '}') --depth;
    if (depth == 0 && c == ':' && name[i + 1] == ':') begin = i + 2;
  }
  return name.substr(begin);
}

// FNV-1a, 64 bits.
constexpr std::uint64_t hash_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash ^ (hash >> 32);
}

template <class T>
inline constexpr TypeInfo kTypeInfo{parse_type_name<T>(), without_namespaces(parse_type_name<T>()),
                                    hash_name(parse_type_name<T>())};

}  // namespace detail

template <class T>
constexpr TypeId type_id() {
  return &detail::kTypeInfo<std::remove_cv_t<T>>;
}

// Open-addressing table with few entries and far more reads than writes. Values stay where they are until insert.
template <class V>
class TypeTable {
 public:
  const V* find(TypeId type) const {
    if (slots_.empty()) return nullptr;
    for (std::size_t i = type->hash & mask();; i = (i + 1) & mask()) {
      if (slots_[i].type == type) return &slots_[i].value;
      if (slots_[i].type == nullptr) return nullptr;
    }
  }

  // `type` must be new.
  void insert(TypeId type, V value) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    place(type, std::move(value));
    ++size_;
  }

  std::size_t size() const { return size_; }

 private:
  struct Slot {
    TypeId type = nullptr;
    V value{};
  };

  std::size_t mask() const { return slots_.size() - 1; }

  void place(TypeId type, V value) {
    std::size_t i = type->hash & mask();
    while (slots_[i].type != nullptr) i = (i + 1) & mask();
    slots_[i] = {type, std::move(value)};
  }

  void grow() {
    std::vector<Slot> old(slots_.empty() ? 16 : 2 * slots_.size());
    old.swap(slots_);
    for (Slot& slot : old) {
      if (slot.type != nullptr) place(slot.type, std::move(slot.value));
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace fascicle::ecs
