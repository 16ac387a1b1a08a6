// `fascicle-cook slices` as a program: exit statuses, messages and files.

#include <gmock/gmock.h>

#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

using testing::HasSubstr;

class SlicesCommand : public CookCommand {
 protected:
  int run(const std::string& arguments) const { return CookCommand::run("slices " + arguments); }
};

TEST_F(SlicesCommand, WrongUsage) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("walker --at 1.5"), 2);
  EXPECT_THAT(err(), HasSubstr("not in range"));
  EXPECT_EQ(run("walker --at half"), 2);
  EXPECT_EQ(run("walker --at nan"), 2);
  EXPECT_EQ(run("walker --unit furlong"), 2);
  EXPECT_THAT(err(), HasSubstr("furlong"));
}

TEST_F(SlicesCommand, WhatIsNotThere) {
  EXPECT_EQ(run("wlaker"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'walker'?"));
  write_obj("thigh.obj", test::make_box({0, 0, 0}, {1, 1, 4}));
  EXPECT_EQ(run("'" + file("tihgh.obj") + "'"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'thigh.obj'?"));
}

TEST_F(SlicesCommand, MeshesThatCannotBeSliced) {
  std::ofstream(file("empty.obj")) << "v 0 0 0\n";
  write_obj("box.obj", test::make_box({0, 0, 0}, {1, 1, 4}));
  // The other mesh is sliced all the same.
  EXPECT_EQ(run("'" + file("empty.obj") + "' '" + file("box.obj") + "'"), 1);
  EXPECT_THAT(err(), HasSubstr("empty"));
  EXPECT_THAT(out(), HasSubstr("3 slices of 1 mesh"));
}

TEST_F(SlicesCommand, APlaneThatMissesIsAWarning) {
  write_obj("box.obj", test::make_box({0, 0, 0}, {1, 1, 4}));
  EXPECT_EQ(run("'" + file("box.obj") + "' --at 0.5 --at 0"), 0);
  // Half-way there is a slice; at 0 the plane lies in the box's end, which counts as one side of it or the other.
  EXPECT_THAT(out(), HasSubstr("of 1 mesh"));
  write_obj("apart.obj", test::join(test::make_box({0, 0, 0}, {1, 1, 1}), test::make_box({0, 0, 9}, {1, 1, 10})));
  EXPECT_EQ(run("'" + file("apart.obj") + "' --at 0.5"), 0);
  EXPECT_THAT(err(), HasSubstr("the plane at 0.5 of the length misses the mesh"));
  EXPECT_THAT(out(), HasSubstr("1 more plane missed"));
}

TEST_F(SlicesCommand, FilesThatCannotBeWritten) {
  write_obj("box.obj", test::make_box({0, 0, 0}, {1, 1, 4}));
  EXPECT_EQ(run("'" + file("box.obj") + "' --csv /dev/null/a.csv --svg /dev/null/a.svg"), 1);
  EXPECT_THAT(err(), HasSubstr("a.csv"));
  EXPECT_THAT(err(), HasSubstr("a.svg"));
}

TEST_F(SlicesCommand, ABoxInMillimetres) {
  write_obj("box.obj", test::make_box({0, 0, 0}, {10, 20, 60}));
  ASSERT_EQ(run("'" + file("box.obj") + "' --unit mm --at 0.5 --csv '" + file("a.csv") + "' --svg '" + file("a.svg") +
                "'"),
            0)
      << err();
  EXPECT_THAT(read("a.csv"), HasSubstr("\nbox,0.5,0,1,200,60,0.698132,"));
  EXPECT_THAT(read("a.svg"), HasSubstr("Slices of box"));
  EXPECT_EQ(err(), "");
}

// The default content is like the bodies that the method's authors sliced: q around 0.6, 75 % above 0.5, most concave.
TEST_F(SlicesCommand, TheWalkerIsLikeTheAuthorsBodies) {
  ASSERT_EQ(run("walker --csv '" + file("walker.csv") + "'"), 0) << err();
  const auto number_after = [text = out()](const std::string& words) {
    const std::size_t found = text.find(words);
    return found == std::string::npos ? -1.0 : std::strtod(text.c_str() + found + words.size(), nullptr);
  };
  EXPECT_GE(number_after(""), 72.0) << out();
  EXPECT_NEAR(number_after("isoperimetric quotient  mean "), 0.6, 0.1);
  EXPECT_NEAR(number_after("quotient above 0.5"), 75.0, 12.0);
  EXPECT_GT(number_after("\n  concave"), 50.0);
}

TEST_F(SlicesCommand, AnatomicalMeshes) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const std::string folder = (test::data_folder() / "pbd").string();
  ASSERT_EQ(run("'" + folder + "/gluteus_maximus.vtk' '" + folder + "/iliacus.vtk' --unit mm"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("6 slices of 2 meshes\n"));
  EXPECT_THAT(out(), HasSubstr("centroid outside        0 %"));
}

}  // namespace
}  // namespace fascicle::cook
