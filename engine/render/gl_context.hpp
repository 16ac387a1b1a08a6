// What the two kinds of context, Window and Headless, have in common: the check that the driver can do what the
// renderer needs, and the log of GL's own complaints.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle {

// Who draws. Strings as the driver gives them.
struct GlInfo {
  std::string version;
  std::string vendor;
  std::string renderer;
  int major = 0;
  int minor = 0;
  bool software = false;  // llvmpipe, softpipe or swrast
};

// Reads the current context's strings; an error, with a remedy, where it is less than OpenGL 4.5.
// `origin` names the context in the error ("window", "EGL surfaceless").
Result<GlInfo> check_context(const std::string& origin);

// Collects KHR_debug messages of the current context. Must outlive the context or be destroyed while it is current.
class GlDebugLog {
 public:
  GlDebugLog();
  ~GlDebugLog();
  GlDebugLog(const GlDebugLog&) = delete;
  GlDebugLog& operator=(const GlDebugLog&) = delete;

  // Errors and undefined behaviour that GL reported since the last call (at most 64 are kept), oldest first.
  std::vector<std::string> take_errors();
  // Performance and portability warnings likewise.
  std::vector<std::string> take_warnings();

  void record(bool is_error, std::string message);

 private:
  std::mutex mutex_;
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

}  // namespace fascicle
