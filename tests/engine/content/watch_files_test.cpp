#include "engine/content/watch_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <string>

#include "engine/content/file_text.hpp"
#include "tests/engine/content/temporary_folder.hpp"

namespace fascicle {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class WatchFiles : public testing::Test {
 protected:
  std::vector<std::filesystem::path> poll(int times) {
    std::vector<std::filesystem::path> changed;
    for (int i = 0; i < times; ++i) watcher_.poll(changed);
    return changed;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path a_ = folder_ / "a.json";
  std::filesystem::path b_ = folder_ / "b.json";
  FileWatcher watcher_{std::chrono::seconds(0)};  // polls alone count
};

TEST_F(WatchFiles, UnchangedFilesAreQuiet) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_, a_});
  EXPECT_THAT(poll(5), IsEmpty());
  test::write_in_place(a_, "one");  // touched, but the same
  EXPECT_THAT(poll(5), IsEmpty());
}

TEST_F(WatchFiles, AnEditIsReportedOnceWhenItIsStable) {
  test::write_in_place(a_, "one");
  test::write_in_place(b_, "one");
  watcher_.watch({a_, b_});
  test::write_in_place(a_, "two");
  EXPECT_THAT(poll(1), IsEmpty());
  EXPECT_THAT(poll(1), ElementsAre(a_));
  EXPECT_THAT(poll(5), IsEmpty());
}

TEST_F(WatchFiles, QuickEditsOfTheSameSizeAreNotLost) {
  test::write_in_place(a_, "0000");
  watcher_.watch({a_});
  for (int i = 1; i <= 200; ++i) {
    test::write_in_place(a_, std::to_string(1000 + i));
    EXPECT_THAT(poll(2), ElementsAre(a_)) << i;
  }
}

TEST_F(WatchFiles, AtomicSavesAreSeen) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(write_text_atomically(a_, std::to_string(i)).ok());
    EXPECT_THAT(poll(2), ElementsAre(a_));
  }
}

TEST_F(WatchFiles, HalfWrittenFilesWait) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  test::write_in_place(a_, "");
  EXPECT_THAT(poll(3), IsEmpty());  // truncated, nothing written yet
  test::write_in_place(a_, "tw");
  EXPECT_THAT(poll(1), IsEmpty());
  test::write_in_place(a_, "two");
  EXPECT_THAT(poll(1), IsEmpty());
  EXPECT_THAT(poll(1), ElementsAre(a_));
}

TEST_F(WatchFiles, AFileMayVanishAndComeBack) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  std::filesystem::remove(a_);
  EXPECT_THAT(poll(3), IsEmpty());
  EXPECT_THAT(watcher_.missing(), ElementsAre(a_));
  test::write_in_place(a_, "one");
  EXPECT_THAT(poll(3), IsEmpty());  // back as it was
  EXPECT_THAT(watcher_.missing(), IsEmpty());
  std::filesystem::remove(a_);
  poll(1);
  test::write_in_place(a_, "two");
  EXPECT_THAT(poll(3), ElementsAre(a_));
}

TEST_F(WatchFiles, AFileThatStaysAwayIsReportedAndSoIsItsReturn) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  std::filesystem::remove(a_);
  EXPECT_THAT(poll(FileWatcher::kSettlePolls - 1), IsEmpty());
  EXPECT_THAT(poll(1), ElementsAre(a_));
  EXPECT_THAT(poll(20), IsEmpty());
  test::write_in_place(a_, "one");  // as it was, but its owner took it for lost
  EXPECT_THAT(poll(2), ElementsAre(a_));
  EXPECT_THAT(poll(20), IsEmpty());
}

TEST_F(WatchFiles, AFileThatStaysEmptyIsReportedAndSoIsItsReturn) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  test::write_in_place(a_, "");
  EXPECT_THAT(poll(FileWatcher::kSettlePolls - 1), IsEmpty());
  EXPECT_THAT(poll(1), ElementsAre(a_));
  EXPECT_THAT(poll(20), IsEmpty());
  std::filesystem::remove(a_);  // another error
  EXPECT_THAT(poll(20), ElementsAre(a_));
  test::write_in_place(a_, "one");
  EXPECT_THAT(poll(2), ElementsAre(a_));
}

TEST_F(WatchFiles, AFileThatBecomesUnreadableIsReportedAndSoIsItsReturn) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read every file";
  test::write_in_place(a_, "one");
  std::filesystem::last_write_time(a_, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  watcher_.watch({a_});
  EXPECT_THAT(poll(3), IsEmpty());
  std::filesystem::permissions(a_, std::filesystem::perms::none);
  EXPECT_THAT(poll(20), ElementsAre(a_));
  std::filesystem::permissions(a_, std::filesystem::perms::owner_read);
  EXPECT_THAT(poll(3), ElementsAre(a_));
}

TEST_F(WatchFiles, TheSettleTimeCountsBesidesThePolls) {
  FileWatcher patient(std::chrono::hours(1));
  test::write_in_place(a_, "one");
  patient.watch({a_});
  std::filesystem::remove(a_);
  std::vector<std::filesystem::path> changed;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(patient.poll(changed));
  test::write_in_place(a_, "two");
  EXPECT_FALSE(patient.poll(changed));
  EXPECT_TRUE(patient.poll(changed));
}

TEST_F(WatchFiles, AnAbsentFileIsReportedWhenItAppears) {
  watcher_.watch({a_});
  EXPECT_THAT(poll(2), IsEmpty());
  test::write_in_place(a_, "one");
  EXPECT_THAT(poll(2), ElementsAre(a_));
}

TEST_F(WatchFiles, WatchingAgainKeepsWhatIsKnown) {
  test::write_in_place(a_, "one");
  watcher_.watch({a_});
  test::write_in_place(a_, "two");
  test::write_in_place(b_, "one");
  watcher_.watch({b_, a_});  // the edit of a is older than this call and must not be lost
  EXPECT_THAT(poll(2), ElementsAre(a_));
  watcher_.watch({b_});
  test::write_in_place(a_, "three");
  EXPECT_THAT(poll(2), IsEmpty());
}

TEST_F(WatchFiles, OldFilesSettleAndAreStillSeenToChange) {
  test::write_in_place(a_, "one");
  const auto past = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(a_, past);
  watcher_.watch({a_});
  EXPECT_THAT(poll(3), IsEmpty());
  test::write_in_place(a_, "two");
  EXPECT_THAT(poll(2), ElementsAre(a_));
}

}  // namespace
}  // namespace fascicle
