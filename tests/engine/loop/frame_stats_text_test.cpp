// The three outputs of FrameStats, on times that are known but for the frame's own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "engine/loop/frame_stats.hpp"
#include "tests/engine/loop/parse_json.hpp"

namespace fascicle {
namespace {

FrameStats make_stats() {
  FrameStats stats({1, 16});
  for (int i = 0; i < 3; ++i) {
    const std::vector<ecs::SystemTiming> timings{{"solve, \"fast\"", 0, 2'000'000, 0, 0}, {"skin", 0, 1'000'000, 1, 0}};
    stats.begin_frame();
    stats.record(timings);
    stats.record_gpu("muscles", 500'000);
    stats.end_frame();
  }
  stats.set_clamped_steps(7);
  stats.set_note("workers", "4");
  stats.set_note("scene", "walk\ner");
  stats.set_note("workers", "8");
  stats.set_memory({{"ActionLines", 3, 4096}, {"Tendons", 2, 100}});
  stats.add_rows({{"solve", "walker 0", "soleus_r", 2, 0.25, 0.5, 1}, {"solve", "walker 0", "", 2, 1, 2, 3}});
  return stats;
}

// RFC 4180, as far as it goes here.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row{""};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      row.back() += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      row.emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back(row);
      row = {""};
    } else {
      row.back() += c;
    }
  }
  EXPECT_FALSE(quoted);
  return rows;
}

TEST(FrameStatsText, EmptyOutputsAreWellFormed) {
  const FrameStats stats;
  const Json::Value json = test::parse_json(stats.to_json());
  EXPECT_EQ(json["frames"].asInt(), 0);
  EXPECT_EQ(json["rows"].size(), 2u);
  for (const std::vector<std::string>& row : parse_csv(stats.to_csv())) EXPECT_EQ(row.size(), 14u);
}

TEST(FrameStatsText, Json) {
  const Json::Value json = test::parse_json(make_stats().to_json());
  EXPECT_EQ(json["frames"].asInt(), 2);
  EXPECT_EQ(json["warm_up_frames"].asInt(), 1);
  EXPECT_EQ(json["clamped_steps"].asInt(), 7);
  EXPECT_TRUE(json["measuring_percent"].isDouble());
  EXPECT_EQ(json["notes"]["workers"].asString(), "8");
  EXPECT_EQ(json["notes"]["scene"].asString(), "walk\ner");
  ASSERT_EQ(json["rows"].size(), 5u);
  const Json::Value& solve = json["rows"][1];
  EXPECT_EQ(solve["kind"].asString(), "system");
  EXPECT_EQ(solve["name"].asString(), "solve, \"fast\"");
  EXPECT_EQ(solve["frames"].asInt(), 2);
  for (const char* value : {"min_ms", "mean_ms", "p50_ms", "p95_ms", "p99_ms", "max_ms"}) {
    EXPECT_NEAR(solve[value].asDouble(), 2, 1e-6) << value;
  }
  EXPECT_EQ(json["rows"][3]["kind"].asString(), "gpu");
  EXPECT_EQ(json["items"].size(), 2u);
  EXPECT_EQ(json["items"][0]["item"].asString(), "soleus_r");
  EXPECT_EQ(json["memory"][1]["component"].asString(), "Tendons");
  EXPECT_EQ(json["memory"][1]["bytes"].asInt(), 100);
}

TEST(FrameStatsText, Csv) {
  const std::vector<std::vector<std::string>> rows = parse_csv(make_stats().to_csv());
  ASSERT_EQ(rows.size(), 1u + 2 + 2 + 5 + 2 + 2);
  for (const std::vector<std::string>& row : rows) ASSERT_EQ(row.size(), 14u) << row[0];
  EXPECT_EQ(rows[0][0], "kind");
  EXPECT_EQ(rows[1], (std::vector<std::string>{"note", "workers", "", "", "", "", "", "", "", "", "", "", "", "8"}));
  EXPECT_EQ(rows[3][1], "clamped_steps");
  EXPECT_EQ(rows[3][11], "7");
  EXPECT_EQ(rows[6][1], "solve, \"fast\"");
  EXPECT_EQ(rows[6][5], "2.000000");
  EXPECT_EQ(rows[10][3], "soleus_r");
  EXPECT_EQ(rows[10][6], "0.500000");
  EXPECT_EQ(rows[12][12], "4096");
}

TEST(FrameStatsText, TableNamesEverything) {
  const std::string table = make_stats().to_table();
  for (const char* part :
       {"2 frames, 1 more left out as warm-up, 7 catch-up steps dropped", "workers: 8", "solve, \"fast\"", "skin",
        "muscles", "measuring itself takes", "soleus_r", "(all)", "ActionLines", "4096", "4196", "p95"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
}

TEST(FrameStatsText, WriteGoesByExtension) {
  const FrameStats stats = make_stats();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "fascicle_frame_stats";
  std::filesystem::create_directories(folder);
  const auto written = [&](const char* name) {
    EXPECT_TRUE(stats.write(folder / name).ok());
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(written("s.csv"), stats.to_csv());
  EXPECT_EQ(written("s.json"), stats.to_json());
  EXPECT_EQ(written("s.txt"), stats.to_table());
  EXPECT_TRUE(stats.write(folder / "new" / "s.csv").ok()) << "missing folders are made";
  EXPECT_FALSE(stats.write(folder / "s.csv" / "below").ok());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fascicle
