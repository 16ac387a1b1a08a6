// fascicle-check as a program: its exit status and what it prints.

#include <cstdio>
#include <cstdlib>
#include <sys/wait.h>

#include <gmock/gmock.h>

#include "engine/content/json_reader.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle {
namespace {

using test::ScratchFolder;
using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string output;  // standard output
};

Outcome run(const std::string& arguments, const std::string& redirections = "2>/dev/null") {
  const std::string command = std::string(FASCICLE_CHECK) + " " + arguments + " " + redirections;
  Outcome result;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  char buffer[4096];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
    result.output.append(buffer, count);
  }
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

TEST(FascicleCheck, WrongUsageIsTwo) {
  EXPECT_EQ(run("").status, 2);
  EXPECT_EQ(run("--colour red x.scene.json").status, 2);
  EXPECT_EQ(run("--format xml x.scene.json").status, 2);
  EXPECT_EQ(run("--help").status, 0);
}

TEST(FascicleCheck, FineIsZeroAndBrokenIsOne) {
  const ScratchFolder folder;
  const std::string scene = write_pair(folder).string();
  EXPECT_EQ(run(scene).status, 0);
  EXPECT_EQ(run("--format json " + scene).output, "{\"errors\":[],\"warnings\":[]}\n");
  folder.write("legs.character.json", test::with(std::string(test::kLegs), "1365", "-1365"));
  const Outcome broken = run(scene);
  EXPECT_EQ(broken.status, 1);
  EXPECT_THAT(broken.output, HasSubstr(folder.path().string() +
                                       "/legs.character.json:35:30: /muscles/0/max_isometric_force: -1365 is out of "
                                       "range; write a number between 0 and 10000000\n"));
  EXPECT_EQ(run(folder.path().string() + "/none.scene.json").status, 1);
  EXPECT_EQ(run(folder.path().string() + "/block.character.json " + scene).status, 1);
}

TEST(FascicleCheck, ChecksSurfaceMusclesDownToTheirMeshes) {
  const test::ScratchFolder folder;
  std::string file = test::write_limb(folder).string();
  EXPECT_EQ(run(file).status, 0);
  file = test::write_limb(folder, test::with(std::string(test::kLimb), R"("ball.obj", "unit": "mm")", R"("ball.obj")"));
  const Outcome broken = run("--format json " + file);
  EXPECT_EQ(broken.status, 1);
  EXPECT_THAT(broken.output, testing::HasSubstr("/surface_muscles/0/mesh"));
  EXPECT_THAT(broken.output, testing::HasSubstr("346 m long"));
}

TEST(FascicleCheck, PrintsJson) {
  const ScratchFolder folder;
  write_pair(folder);
  const auto file = folder.write("legs.character.json", test::with(std::string(test::kLegs), "1365", "-1365"));
  const Outcome broken = run("--format json " + file.string());
  EXPECT_EQ(broken.status, 1);
  const auto document = parse_json(broken.output, "output");
  ASSERT_TRUE(document.ok()) << broken.output;
  const JsonNode errors = document->root().member("errors");
  ASSERT_EQ(errors.size(), 1u);
  Diagnostics diagnostics;
  JsonObject error(errors.element(0), diagnostics);
  std::string where, path, cause, remedy;
  int line = 0, column = 0;
  EXPECT_TRUE(error.require("file", where) && error.require("line", line) && error.require("column", column));
  EXPECT_TRUE(error.require("path", path) && error.require("cause", cause) && error.require("remedy", remedy));
  error.finish();
  EXPECT_TRUE(diagnostics.ok()) << to_text(diagnostics);
  EXPECT_EQ(where, file.string());
  EXPECT_EQ(line, 35);
  EXPECT_EQ(column, 30);
  EXPECT_EQ(path, "/muscles/0/max_isometric_force");
}

TEST(FascicleCheck, WarningsDoNotFailAndMigrationEndsThem) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", test::kShapes);
  const std::string file =
      folder.write("block.character.json", test::with(std::string(test::kBlock), "\"version\": 1", "\"version\": 0"))
          .string();
  Outcome old = run(file);
  EXPECT_EQ(old.status, 0);
  EXPECT_THAT(old.output, HasSubstr("warning: " + file + ":2:14: /version: the file has version 0"));
  EXPECT_EQ(run("--migrate " + file).status, 0);
  old = run(file);
  EXPECT_EQ(old.status, 0);
  EXPECT_THAT(old.output, testing::Not(HasSubstr("warning")));
}

TEST(FascicleCheck, MigrationChecksTheFile) {
  const ScratchFolder folder;
  const std::string file = folder.write("block.character.json", test::kBlock).string();
  const Outcome migrated = run("--migrate " + file);
  EXPECT_EQ(migrated.status, 1);
  EXPECT_THAT(migrated.output, HasSubstr("'shapes.gltf' does not exist"));
  EXPECT_THAT(migrated.output, testing::Not(HasSubstr("fine")));
}

TEST(FascicleCheck, OutputThatIsLostIsAFailure) {
  const ScratchFolder folder;
  const std::string scene = write_pair(folder).string();
  for (const std::string& arguments : {scene, std::string("--print-schema scene"), "--format json " + scene}) {
    const Outcome full = run(arguments, "2>&1 >/dev/full");
    EXPECT_EQ(full.status, 1) << arguments;
    EXPECT_THAT(full.output, HasSubstr("fascicle-check: ")) << arguments;
    EXPECT_THAT(full.output, HasSubstr("No space left")) << arguments;
  }
}

TEST(FascicleCheck, SuggestsFilesForNamesWithoutOne) {
  ASSERT_EQ(::setenv("FASCICLE_CONTENT", FASCICLE_SOURCE_DIR "/content", 1), 0);
  Outcome missing = run("wlaker");
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.output, HasSubstr("wlaker: no such file; did you mean '" FASCICLE_SOURCE_DIR "/content/"));
  EXPECT_THAT(missing.output, HasSubstr("walker.character.json'"));
  missing = run("wlaker.scene.json");
  EXPECT_THAT(missing.output,
              HasSubstr("did you mean '" FASCICLE_SOURCE_DIR "/content/scenes/walker.scene.json'?"));
  missing = run("qqqqqqqqqqqqqqqqqqqqqqqqq");
  EXPECT_THAT(missing.output, HasSubstr("known files: "));
  ::unsetenv("FASCICLE_CONTENT");
}

TEST(FascicleCheck, PrintsTheSchemas) {
  for (const char* kind : {"character", "scene", "joints"}) {
    const Outcome schema = run(std::string("--print-schema ") + kind);
    EXPECT_EQ(schema.status, 0) << kind;
    EXPECT_TRUE(parse_json(schema.output, kind).ok()) << kind;
  }
  EXPECT_EQ(run("--print-schema muscle").status, 2);
}

}  // namespace
}  // namespace fascicle
