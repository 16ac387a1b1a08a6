// A happens-before edge that the thread sanitizer can see. oneTBB orders the start and the end of a parallel loop
// itself, but Debian's library is not instrumented, so the sanitizer cannot know and would report races that are
// none. A Handoff repeats that order with an atomic of our own; without the sanitizer it compiles to nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define FASCICLE_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define FASCICLE_THREAD_SANITIZER 1
#endif
#endif

#ifdef FASCICLE_THREAD_SANITIZER
#include <atomic>
#endif

namespace fascicle::parallel {

class Handoff {
 public:
  // All that this thread did so far is visible to whoever receives afterwards.
#ifdef FASCICLE_THREAD_SANITIZER
  void send() { count_.fetch_add(1, std::memory_order_acq_rel); }
  void receive() const { (void)count_.load(std::memory_order_acquire); }

 private:
  std::atomic<int> count_ = 0;
#else
  void send() {}
  void receive() const {}
#endif
};

}  // namespace fascicle::parallel
