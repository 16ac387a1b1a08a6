// Reads what the loop writes with a JSON library, strictly.
#pragma once

#include <json/json.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace fascicle::test {

inline Json::Value parse_json(const std::string& text) {
  Json::CharReaderBuilder builder;
  Json::CharReaderBuilder::strictMode(&builder.settings_);
  const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
  Json::Value value;
  std::string errors;
  EXPECT_TRUE(reader->parse(text.data(), text.data() + text.size(), &value, &errors)) << errors;
  return value;
}

}  // namespace fascicle::test
