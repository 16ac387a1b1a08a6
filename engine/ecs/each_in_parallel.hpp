// View::each on all workers, for systems whose entities do not touch each other.
#pragma once

#include <cstddef>

#include "engine/ecs/view.hpp"
#include "engine/parallel/for_range.hpp"

namespace fascicle::ecs {

// Calls f(Ts&...) or f(Entity, Ts&...) for each entity of the view, `grain` candidates a chunk, in any order and at the
// same time: f writes only the components it is given. Results do not depend on the number of workers.
template <class F, class... Ts>
void each_in_parallel(View<Ts...> view, std::size_t grain, F&& f) {
  parallel::for_range(view.candidates(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) view.visit(i, f);
  });
}

}  // namespace fascicle::ecs
