// From a function's signature to a system the schedule can run: the parameter types say what it reads and writes, and
// how to fetch each argument from the world. Any function, lambda or function object will do whose parameters are
// View<...>, Resource<T> and Commands&, and which returns nothing.
#pragma once

#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/ecs/access.hpp"
#include "engine/ecs/commands.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/ecs/world.hpp"

namespace fascicle::ecs {

struct SystemContext {
  World& world;
  Commands& commands;
  std::string_view name;  // of the system, for errors
};

namespace detail {

// std::logic_error that names both and says what to do.
[[noreturn]] void throw_missing_resource(std::string_view system, TypeId resource);

template <class P>
struct Parameter {
  static_assert(!sizeof(P), "a system's parameters are View<...>, Resource<T> and Commands&");
};

template <class... Ts>
struct Parameter<View<Ts...>> {
  static void declare(Access& access) { (access.declare({type_id<Ts>(), false, !std::is_const_v<Ts>}), ...); }
  static View<Ts...> fetch(SystemContext& context) { return context.world.view<Ts...>(); }
};

template <class T>
struct Parameter<Resource<T>> {
  static void declare(Access& access) { access.declare({type_id<T>(), true, !std::is_const_v<T>}); }
  static Resource<T> fetch(SystemContext& context) {
    T* found = context.world.try_resource<T>();
    if (found == nullptr) throw_missing_resource(context.name, type_id<T>());
    return Resource<T>(*found);
  }
};

template <>
struct Parameter<Commands> {
  static void declare(Access& access) { access.declare_commands(); }
  static Commands& fetch(SystemContext& context) { return context.commands; }
};

// The parameter types of a callable.
template <class F>
struct Signature : Signature<decltype(&F::operator())> {};

template <class... Ps>
struct Signature<void (*)(Ps...)> {
  static_assert(((!std::is_same_v<std::remove_cvref_t<Ps>, Commands> || std::is_same_v<Ps, Commands&>) && ...),
                "take Commands by reference");

  static Access access() {
    Access result;
    (Parameter<std::remove_cvref_t<Ps>>::declare(result), ...);
    return result;
  }
  template <class F>
  static void call(F& f, [[maybe_unused]] SystemContext& context) {
    f(Parameter<std::remove_cvref_t<Ps>>::fetch(context)...);
  }
};
template <class... Ps>
struct Signature<void (*)(Ps...) noexcept> : Signature<void (*)(Ps...)> {};
template <class C, class... Ps>
struct Signature<void (C::*)(Ps...)> : Signature<void (*)(Ps...)> {};
template <class C, class... Ps>
struct Signature<void (C::*)(Ps...) const> : Signature<void (*)(Ps...)> {};
template <class C, class... Ps>
struct Signature<void (C::*)(Ps...) noexcept> : Signature<void (*)(Ps...)> {};
template <class C, class... Ps>
struct Signature<void (C::*)(Ps...) const noexcept> : Signature<void (*)(Ps...)> {};

}  // namespace detail

// One virtual call a system and frame.
class System {
 public:
  virtual ~System() = default;
  virtual void run(SystemContext& context) = 0;
};

template <class F>
class SystemOf final : public System {
 public:
  explicit SystemOf(F f) : function_(std::move(f)) {}
  static Access access() { return detail::Signature<F>::access(); }
  void run(SystemContext& context) override { detail::Signature<F>::call(function_, context); }

 private:
  F function_;
};

}  // namespace fascicle::ecs
