// What a command line program owes its caller at the end: output that could not be written, and exceptions that nobody
// expected, end in a message on standard error and a status that says so, never in silence or an abort.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include <fmt/core.h>

namespace fascicle {

// Runs `body`, which returns the exit status, then checks that all it printed went out. `failure` is the status where
// it did not, or where memory ran out or another exception came.
template <class Body>
int run_program(const char* name, Body&& body, int failure = 1) {
  int status = failure;
  try {
    status = body();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: out of memory; ask for less\n", name);
    return failure;
  } catch (const std::exception& thrown) {  // fmt's printing throws these, too, where the disk is full
    fmt::print(stderr, "{}: {}\n", name, thrown.what());
    std::fflush(stdout);
    return failure;
  }
  errno = 0;
  const bool failed_before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) != 0 || failed_before) {
    fmt::print(stderr, "{}: standard output cannot be written{}{}\n", name, errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
    return status == 0 ? failure : status;
  }
  return status;
}

}  // namespace fascicle
