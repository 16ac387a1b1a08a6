#include "modules/muscle/content/find_content.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

// Sets an environment variable for one test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (old_.empty()) {
      unsetenv(name_);
    } else {
      setenv(name_, old_.c_str(), 1);
    }
  }

 private:
  const char* name_;
  std::string old_;
};

TEST(FindContent, TheEnvironmentGoesFirst) {
  const test::ScratchFolder folder;
  const Variable content("FASCICLE_CONTENT", folder.path().string());
  EXPECT_EQ(find_content_folder(), folder.path());
}

TEST(FindContent, ADataFolderThatIsNotThereIsNone) {
  const test::ScratchFolder folder;
  {
    const Variable data("FASCICLE_DATA", folder.path().string());
    EXPECT_EQ(find_data_folder(), folder.path());
  }
  const Variable data("FASCICLE_DATA", (folder.path() / "none").string());
  EXPECT_TRUE(find_data_folder().empty());
}

TEST(FindContent, DataLiesBesideTheProject) {
  const test::ScratchFolder folder;
  folder.write("project/content/scenes/x", "");
  folder.write("shared/data/x", "");
  const Variable content("FASCICLE_CONTENT", (folder.path() / "project" / "content").string());
  const Variable data("FASCICLE_DATA", "");
  EXPECT_EQ(find_data_folder(), std::filesystem::canonical(folder.path()) / "shared" / "data");
}

TEST(FindScene, ByNameOrByPath) {
  const std::filesystem::path content = "/somewhere/content";
  EXPECT_EQ(find_scene("walker", content), content / "scenes" / "walker.scene.json");
  EXPECT_EQ(find_scene("mine/x.scene.json", content), "mine/x.scene.json");
  const test::ScratchFolder folder;
  const auto plain = folder.write("scene", "{}");
  EXPECT_EQ(find_scene(plain.string(), content), plain);
}

}  // namespace
}  // namespace fascicle::muscle
