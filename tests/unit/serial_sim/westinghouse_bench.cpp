#include "tests/unit/serial_sim/westinghouse_bench.hpp"

#include <fstream>
#include <iterator>
#include <sstream>

#include "serial_sim/line/frame.hpp"
#include "tests/support/source_path.hpp"

namespace s7200::westinghouse {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// `00*508` written out.
std::string expanded(const std::vector<std::string>& bytes) {
  std::string hex;
  for (const std::string& byte : bytes) {
    const std::size_t star = byte.find('*');
    const int times = star == std::string::npos ? 1 : std::stoi(byte.substr(star + 1));
    for (int i = 0; i < times; ++i) hex += byte.substr(0, star) + " ";
  }
  return hex;
}

std::string normal(const std::string& hex) {
  if (hex.empty()) return {};
  const serial::ParsedFrame parsed = serial::parse_hex_frame(hex);
  EXPECT_TRUE(parsed.ok()) << hex;
  return serial::to_hex(serial::bytes_of(parsed.frame));
}

struct Step {
  std::string kind;  // `>`, `<`, `=`, or one with an at sign
  std::vector<std::string> words;
};

std::vector<Step> steps_of(const std::string& text) {
  std::vector<Step> steps;
  for (const std::string& word : words_of(text)) {
    if (word == ">" || word == ">!" || word == "<" || word == "=")
      steps.push_back({word.substr(0, 1), {}});
    else if (word[0] == '@')
      steps.push_back({word, {}});
    else
      steps.back().words.push_back(word);
  }
  return steps;
}

void play_on(Bench& bench, const ExchangeRecord& record, const std::map<std::string, ExchangeRecord>& all) {
  std::string settings;
  for (const std::string& word : words_of(record.state)) {
    if (word == "-") continue;
    if (word.starts_with("after="))
      play_on(bench, all.at(word.substr(6)), all);
    else
      settings += word + " ";
  }
  bench.set(settings);
  SCOPED_TRACE(record.id + ": " + record.steps);
  const std::vector<Step> steps = steps_of(record.steps);
  bool sync = false;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (step.kind.starts_with("@sync")) {
      sync = step.kind == "@sync+";
    } else if (step.kind.starts_with("@wait:")) {
      bench.wait(std::stoi(step.kind.substr(6)) * kMillisecond);
    } else if (step.kind == "=") {
      std::string texts;
      for (const std::string& word : step.words) texts += word + " ";
      EXPECT_EQ(bench.fault_of(texts), "");
    } else if (step.kind == ">") {
      const std::string answer = bench.ask(expanded(step.words), sync);
      std::size_t next = i + 1;
      while (next < steps.size() && steps[next].kind.starts_with("@sync")) ++next;
      const bool answered = next < steps.size() && steps[next].kind == "<" && steps[next].words[0] != "-";
      std::vector<std::string> words = answered ? steps[next].words : std::vector<std::string>{};
      const bool only_the_start = !words.empty() && words.back() == "..";
      if (only_the_start) words.pop_back();
      const std::string expected = normal(expanded(words));
      EXPECT_EQ(only_the_start ? answer.substr(0, expected.size()) : answer, expected);
    }
  }
}

}  // namespace

Bench::Bench(std::string_view protocol, const std::string& settings)
    : line_(system_.add_line()),
      station_(system_.add_responder(line_, find_plc(protocol)->make())),
      master_(system_.add_requester(line_)) {
  master_.requester().when_sync([this](bool high, Time at) { station_.responder().sync(high, at); });
  set(settings);
}

void Bench::set(const std::string& settings) {
  for (const std::string& text : words_of(settings)) {
    EXPECT_EQ(plc().set(text).why(), "");
  }
  station_.uart().configure(plc().format(), 0);
  master_.uart().configure(plc().format(), 0);
}

std::string Bench::ask(const std::string& hex, bool sync, Time timeout) {
  const serial::ParsedFrame parsed = serial::parse_hex_frame(hex);
  EXPECT_TRUE(parsed.ok()) << hex;
  master_.requester().start({.frame = parsed.frame, .timeout = timeout, .sync = sync}, system_.time());
  return serial::to_hex(system_.finish_exchange(master_).response_bytes());
}

void Bench::lose_power() {
  station_.power_off(system_.time());
  wait(100 * kMillisecond);
  station_.power_on(system_.time());
}

std::string Bench::fault_of(const std::string& texts) const {
  std::string all;
  for (const std::string& text : words_of(texts)) {
    if (const auto done = plc().holds(text); !done) all += done.why().empty() ? text : done.why();
  }
  return all;
}

/// The files call two protocols by the reference's short names.
std::string protocol_called(const std::string& name) {
  return name == "lan" ? "pc1000-lan" : name == "loader" ? "pc500-loader" : name;
}

std::vector<ExchangeRecord> read_exchanges(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == ' ')
      lines.back() += line;
    else
      lines.push_back(line);
  }
  std::vector<ExchangeRecord> records;
  for (const std::string& line : lines) {
    std::istringstream fields(line);
    std::vector<std::string> parts;
    for (std::string part; std::getline(fields, part, '|');) parts.push_back(part);
    EXPECT_EQ(parts.size(), 5U) << line;
    if (parts.size() == 5)
      records.push_back({words_of(parts[0])[0], protocol_called(words_of(parts[1])[0]), parts[3], parts[4]});
  }
  return records;
}

void play(const ExchangeRecord& record, const std::map<std::string, ExchangeRecord>& all) {
  Bench bench(record.protocol);
  play_on(bench, record, all);
}

int play_file(const std::string& text, const std::string& protocol) {
  std::map<std::string, ExchangeRecord> all;
  for (const ExchangeRecord& record : read_exchanges(text)) all.emplace(record.id, record);
  int count = 0;
  for (const auto& [id, record] : all) {
    if (record.protocol != protocol) continue;
    play(record, all);
    ++count;
  }
  return count;
}

std::string text_of(const std::string& path) {
  std::ifstream in(test::source_path(path), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace s7200::westinghouse
