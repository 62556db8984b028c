#include "tools/views/streamed_results.hpp"

#include <gtest/gtest.h>

#include "tools/views/results_json.hpp"

namespace s7200::tools::streamed_results_test {
namespace {

std::string streamed(const std::vector<nlohmann::ordered_json>& entries, const nlohmann::ordered_json& rest) {
  StreamedResults results(results_of("send"), "exchanges");
  std::string text;
  for (const auto& entry : entries) text += results.entry(entry);
  return text + results.end(rest);
}

std::string whole(const std::vector<nlohmann::ordered_json>& entries, const nlohmann::ordered_json& rest) {
  auto results = results_of("send");
  results["exchanges"] = entries;
  results.update(rest);
  return lines_of(results);
}

TEST(StreamedResults, AreTheSameTextAsTheWhole) {
  const nlohmann::ordered_json entry{
      {"request", "01\n02"}, {"values", {1, 2}}, {"none", nullptr}, {"empty", nlohmann::ordered_json::array()}};
  const nlohmann::ordered_json rest{{"time", 1.5}, {"dump", {{"VW0", {{"hex", "00"}}}}}};
  for (const auto& entries : {std::vector<nlohmann::ordered_json>{}, {entry}, {entry, entry, "text"}}) {
    EXPECT_EQ(streamed(entries, rest), whole(entries, rest));
    EXPECT_EQ(streamed(entries, nlohmann::ordered_json::object()), whole(entries, nlohmann::ordered_json::object()));
  }
}

}  // namespace
}  // namespace s7200::tools::streamed_results_test
