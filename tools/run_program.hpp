// What a command line program owes its caller at the end: output that could not be written, and exceptions that nobody
// expected, end in a message on standard error and status 1, never in silence or an abort.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include <fmt/core.h>

namespace fascicle {

// Runs `body`, which returns the exit status, then checks that all it printed went out.
template <class Body>
int run_program(const char* name, Body&& body) {
  int status = 1;
  try {
    status = body();
  } catch (const std::exception& failure) {  // fmt's printing throws these, too, where the disk is full
    fmt::print(stderr, "{}: {}\n", name, failure.what());
    std::fflush(stdout);
    return 1;
  }
  errno = 0;
  const bool failed_before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) != 0 || failed_before) {
    fmt::print(stderr, "{}: standard output cannot be written{}{}\n", name, errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
    return status == 0 ? 1 : status;
  }
  return status;
}

}  // namespace fascicle
