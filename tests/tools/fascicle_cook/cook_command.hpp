// Runs fascicle-cook as a program, in a folder of its own.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/shapes.hpp"

namespace fascicle::cook {

class CookCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("cook_command_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  // The exit status; what it printed is in out() and err().
  int run(const std::string& arguments) const {
    const std::string command = "'" FASCICLE_COOK "' " + arguments + " >'" + file("out") + "' 2>'" + file("err") +
                                "' </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string out() const { return read("out"); }
  std::string err() const { return read("err"); }

  std::string read(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void write_obj(const std::string& name, const TriangleMesh& mesh) const { write(name, test::as_obj(mesh)); }

 private:
  std::filesystem::path folder_;
};

}  // namespace fascicle::cook
