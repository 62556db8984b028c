// Tables of voltages as oscilloscopes export them: whatever stands above their rows, the levels of the line are read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "serial_sim/line/character.hpp"
#include "tools/recordings/conversation.hpp"

namespace s7200::tools::volts_test {
namespace {

const Bytes kRequest{0x01, 0x03, 0x00, 0x0A, 0x00, 0x02, 0xE4, 0x09};
const Bytes kAnswer{0x01, 0x03, 0x04, 0x12, 0x34, 0x56, 0x78, 0x81, 0x07};

constexpr Time kInterval = 20 * kMicrosecond;  // five samples in each bit at 9600 baud

/// The samples of a line of 9600 baud that is at mark but for a request and its answer.
std::vector<bool> samples() {
  const SerialFormat format{};
  std::vector<bool> levels(2'500, true);
  for (const auto& [begin, bytes] : {std::pair(2 * kMillisecond, kRequest), std::pair(25 * kMillisecond, kAnswer)})
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const unsigned bits = serial::character_levels(format, bytes[i], format.parity_bit(bytes[i]));
      const Time start = begin + static_cast<Time>(i) * format.character_time();
      for (Time at = start; at < start + format.bit_times(serial::first_stop_bit(format)); at += kInterval) {
        const auto bit = (at - start) * format.baud / kSecond;
        levels[static_cast<std::size_t>(at / kInterval)] = (bits >> bit & 1U) != 0;
      }
    }
  return levels;
}

using RowOf = std::function<std::string(std::size_t sample, double seconds, bool level)>;

std::string table_of(const std::string& head, const RowOf& row) {
  std::string text = head;
  const auto levels = samples();
  for (std::size_t i = 0; i < levels.size(); ++i) text += row(i, static_cast<double>(i) * 20e-6, levels[i]) + '\n';
  return text;
}

void expect_the_conversation(const std::string& table, const ReadingChoices& choices = {}) {
  const auto recording = read_recording(table, choices);
  ASSERT_TRUE(recording) << recording.why() << '\n' << table.substr(0, 300);
  EXPECT_EQ(recording->form, "volts");
  EXPECT_EQ(recording->line, SerialFormat{});
  const auto frames = conversation(*recording, *find_recorded_protocol("modbus"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame.bytes, kRequest);
  EXPECT_EQ(frames[1].frame.bytes, kAnswer);
  EXPECT_EQ(frames[1].other, 0U);
  EXPECT_NEAR(static_cast<double>(*frames[1].frame.at), 23e6, 3e4) << "to a sample";
}

double volts_of(bool level) { return level ? 3.28 : 0.04; }

TEST(Volts, NamesAndUnitsMayStandInOneRowOrInTwo) {
  const RowOf row = [](std::size_t, double at, bool level) { return fmt::format("{:e},{:.3f}", at, volts_of(level)); };
  expect_the_conversation(table_of("Time(s),CH1(V)\n", row));
  expect_the_conversation(table_of("x-axis,1\nsecond,Volt\n", row));
  expect_the_conversation(table_of("Source,CH1\nSecond,Volt\n", row));
  expect_the_conversation(table_of("Time [s],Channel 0\n", row));
  expect_the_conversation(table_of("Time,C1\n", row));
}

TEST(Volts, TheTimesHaveTheUnitOfTheirColumn) {
  expect_the_conversation(table_of("Time,Channel A\n(ms),(V)\n\n", [](std::size_t, double at, bool level) {
    return fmt::format("{:.8f},{:.5f}", at * 1e3 - 25, volts_of(level));
  }));
  expect_the_conversation(table_of("Zeit (us);Kanal (mV)\n", [](std::size_t, double at, bool level) {
    std::string text = fmt::format("{:.1f};{:.1f}", at * 1e6, 1e3 * volts_of(level));
    std::ranges::replace(text, '.', ',');
    return text;
  }));
}

TEST(Volts, SettingsMayStandAboveOrBesideTheRows) {
  expect_the_conversation(
      table_of("Record Length,Analog:2500\nSample Interval,Analog:0.00002\nVertical Units,CH1:V\nTime,CH1\n",
               [](std::size_t, double at, bool level) { return fmt::format("{:.6f},{:.2f}", at, volts_of(level)); }));
  expect_the_conversation(
      table_of("#Oscilloscope Acquisition\n#Device Name: A, B\n#Sample rate: 50kHz\nTime (s),Channel 1 (V)\n",
               [](std::size_t, double at, bool level) { return fmt::format("{:.6f},{:.3f}", at - 0.01, volts_of(level)); }));
  const std::array<std::string, 4> settings{"Record Length,2.500000e+03,", "Sample Interval,2.000000e-05,",
                                            "Vertical Units,V,", "Horizontal Units,s,"};
  expect_the_conversation(table_of("", [&](std::size_t i, double at, bool level) {
    return fmt::format("{},{:013.6f},{:09.5f},", i < settings.size() ? settings[i] : ",,", at, volts_of(level));
  }));
}

TEST(Volts, RowsMayCountSamplesOfAnIntervalThatTheHeadHas) {
  expect_the_conversation(
      table_of("X,CH1,Start,Increment,\nSequence,Volt,-2.000000e-03,2.000000e-05\n",
               [](std::size_t i, double, bool level) { return fmt::format("{},{:e},,", i, volts_of(level)); }));
  expect_the_conversation(table_of("CH1V,t0 =-0.002, tInc = 2e-05,\n",
                                   [](std::size_t, double, bool level) { return fmt::format("{:e},,", volts_of(level)); }));
}

TEST(Volts, AColumnThatCountsRowsHasNoTimes) {
  const std::string table = table_of("Unit:(mV)\n,CH1,CH2\nFrequency,?,?\n", [](std::size_t i, double, bool level) {
    return fmt::format("{},{:.2f},0.00", i + 1, 1e3 * volts_of(level));
  });
  std::string why = read_recording(table, {}).why();
  EXPECT_TRUE(why.starts_with("it has volts and no times")) << why;
  expect_the_conversation(table, {.samplerate = 50'000});
}

TEST(Volts, WithoutTimesTheUserNamesTheRateOfTheSamples) {
  const std::string table =
      table_of("CH1V\n", [](std::size_t, double, bool level) { return fmt::format("{:.2f}", volts_of(level)); });
  EXPECT_EQ(read_recording(table, {}).why(),
            "it has volts and no times: name the rate of its samples with --samplerate, as 1MHz, or export the times, too");
  expect_the_conversation(table, {.samplerate = 50'000});
}

TEST(Volts, BothWiresOfAPairAreOneLineThatNoiseDoesNotMove) {
  expect_the_conversation(table_of("Time (s),CH1 (V),CH2 (V)\n", [](std::size_t i, double at, bool level) {
    const double noise = 0.05 * static_cast<double>(i % 3);
    return fmt::format("{:.6f},{:.3f},{:.3f}", at, (level ? 2.9 : 1.8) + noise, (level ? 1.7 : 3.0) - noise);
  }));
}

TEST(Volts, AnUndrivenLineBetweenTheFramesKeepsItsLevel) {
  std::size_t idle = 0;
  expect_the_conversation(table_of("Time (s),CH1 (V)\n", [&](std::size_t, double at, bool level) {
    idle = level ? idle + 1 : 0;
    return fmt::format("{:.6f},{:.3f}", at, idle > 80 ? 0.02 : level ? 2.1 : -2.1);
  }));
}

TEST(Volts, WhatIsBeyondTheRangeIsHighOrLow) {
  for (const std::string beyond : {"inf", "\u221E"})
    expect_the_conversation(table_of("Time (s),CH1 (V)\n", [&](std::size_t i, double at, bool level) {
      return fmt::format("{:.6f},{}", at, i % 3 == 1 ? (level ? "" : "-") + beyond : fmt::format("{:.2f}", volts_of(level)));
    }));
}

TEST(Volts, TooFewSamplesAreNamedWithWhatToExport) {
  std::string table = "Time(s),CH1(V)\n";
  const auto levels = samples();
  for (std::size_t i = 0; i < levels.size(); i += 20)
    table += fmt::format("{:.6f},{:.2f}\n", static_cast<double>(i) * 20e-6, volts_of(levels[i]));
  std::string why = read_recording(table, {}).why();
  EXPECT_NE(why.find("its samples are 400 us apart: a line needs four or more in each bit"), std::string::npos) << why;
}

TEST(Volts, ATableOfOtherNumbersHasNone) {
  std::string table = "Time;Level;Flow\n";
  for (int i = 0; i < 20; ++i) table += fmt::format("{};{}.5;{}\n", i, i % 3, i % 7);
  std::string why = read_recording(table, {}).why();
  EXPECT_TRUE(why.starts_with("no column found for the bytes")) << why;
}

}  // namespace
}  // namespace s7200::tools::volts_test
