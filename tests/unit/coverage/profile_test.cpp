// Where simulated time goes: all of it, to the nanosecond.
#include "tools/coverage/profile.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>

#include "interpreter/program/ladder/networks.hpp"
#include "tests/support/plc.hpp"
#include "tools/coverage/profile_report.hpp"

namespace s7200::tools::profile_test {
namespace {

constexpr std::string_view kProgram =
    "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\n"
    "LD SM0.5\nCALL 0\nLD SM0.0\nCALL 1\nMEND\n"
    "SBR 0\nLD SM0.0\nFOR VW0, 1, 200\nINCW VW2\nNEXT\nRET\n"
    "SBR 1\nLD SM0.0\nINCW VW4\nRET\n"
    "INT 0\nLD SM0.0\nINCW VW6\nRETI\n";

Profile profile_of(std::string_view stl, Time until, State* state = nullptr) {
  const auto program = test::program_of(stl);
  ProfileSink sink(program);
  test::Plc plc(program);
  sink.begin(plc.cpu);
  plc.cpu.set_sink(&sink);
  plc.run_until(until);
  if (state) *state = plc.cpu.state();
  return sink.profile();
}

TEST(Profile, PartsAddUpToTheSimulatedTime) {
  State state;
  const Profile profile = profile_of(kProgram, 3 * kSecond, &state);
  const std::vector<Time> ops = profile.by_op();
  EXPECT_EQ(profile.total, state.time);
  EXPECT_EQ(profile.system + profile.entries() + std::accumulate(ops.begin(), ops.end(), Time{0}), state.time);
  EXPECT_EQ(std::accumulate(profile.executed.begin(), profile.executed.end(), std::uint64_t{0}), state.instructions);
  EXPECT_EQ(profile.scans.count() + 1, state.scans) << "the first one had begun before it was watched";
  EXPECT_EQ(profile.scans.most(), state.longest_scan);
  EXPECT_EQ(profile.scans.least(), state.shortest_scan);
}

TEST(Profile, FoldedStacksHaveTheSameSumAndTheWayOfTheCalls) {
  const Profile profile = profile_of(kProgram, kSecond);
  ProfileOfPrograms all;
  all.add(profile, {});
  const std::string folded = profile_folded(all);
  Time sum = 0;
  for (std::size_t at = 0; at < folded.size();) {
    const std::size_t end = folded.find('\n', at);
    sum += std::stoll(folded.substr(folded.rfind(' ', end), end));
    at = end + 1;
  }
  EXPECT_EQ(sum, profile.total);
  for (const char* const each :
       {"system ", "MAIN;network ", "MAIN;SBR_0;network ", "MAIN;SBR_1;network ", "INT_0;entry ", "INT_0;network "})
    EXPECT_NE(folded.find(each), std::string::npos) << each << " in\n" << folded;
  EXPECT_EQ(folded.find("SBR_0;SBR_1"), std::string::npos);
}

TEST(Profile, TheWorstScanIsKnownWithItsRoutines) {
  const Profile profile = profile_of(kProgram, 3 * kSecond);
  ASSERT_TRUE(profile.worst_scan);
  const ProfiledScan& worst = *profile.worst_scan;
  EXPECT_EQ(worst.length, profile.scans.most());
  EXPECT_EQ(std::max_element(worst.routines.begin(), worst.routines.end()) - worst.routines.begin(), 1)
      << "SBR 0 has a loop";
}

TEST(Profile, NetworksHaveTheirTimeInEachScan) {
  const Profile profile = profile_of(kProgram, 3 * kSecond);
  constexpr std::uint32_t kFor = 11;
  const std::uint32_t network = Networks(*profile.program).first_of(kFor);
  ASSERT_TRUE(profile.networks.contains(network));
  const Durations& loop = profile.networks.at(network);
  EXPECT_LT(loop.count(), profile.scans.count()) << "it is called while SM0.5 is on";
  EXPECT_GT(loop.count(), 100U) << "for half of the time, in longer scans";
  EXPECT_GT(loop.least(), 200 * kMicrosecond);
  EXPECT_LT(loop.most(), profile.scans.most());
  EXPECT_EQ(profile.networks.at(0).count(), profile.scans.count()) << "the first network is in each scan";
  EXPECT_NE(profile_text(profile).find(fmt::format("most {}\n", format_duration(loop.most(), 3))), std::string::npos);
}

TEST(Profile, InterruptsAreCountedWithWhatTheyWaitedFor) {
  const Profile profile = profile_of(
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nDISI\nFOR VW0, 1, 200\nNEXT\nENI\n"
      "MEND\nINT 0\nRETI\n",
      kSecond);
  ASSERT_TRUE(profile.events.contains(10));
  const ProfiledEvent& event = profile.events.at(10);
  EXPECT_GT(event.latency.count(), 50U);
  EXPECT_EQ(event.worst.waited, event.latency.most());
  EXPECT_NE(event.worst.why.find("DISI"), std::string::npos) << event.worst.why;
  EXPECT_NE(profile_text(profile).find("event 10, INT_0"), std::string::npos);
}

TEST(Profile, RunsOfAProgramAreMerged) {
  const Profile one = profile_of(kProgram, kSecond), other = profile_of(kProgram, 2 * kSecond);
  ProfileOfPrograms all;
  all.add(one, {"pump", "short", "debug short"}), all.add(other, {"", "long", "debug long"});
  ASSERT_EQ(all.programs().size(), 1U);
  const Profile& both = all.programs().front();
  EXPECT_EQ(both.total, one.total + other.total);
  EXPECT_EQ(both.scans.count(), one.scans.count() + other.scans.count());
  EXPECT_EQ(both.networks.at(0).count(), both.scans.count());
  EXPECT_FALSE(both.worst_scan->in.scenario.empty());
}

TEST(Profile, TheWorstOfSeveralRunsSaysWhereAndHowToLookAtIt) {
  const Profile one = profile_of(kProgram, kSecond), other = profile_of("LD SM0.0\nMEND\n", 10 * kMillisecond);
  ProfileOfPrograms of_system, all;
  of_system.add(one, {"pump", "", ""});
  all.add(of_system, {"", "it starts", "s7200 debug pump.yaml --only 'it starts'"});
  const std::string text = profile_text(all.programs().front());
  EXPECT_NE(text.find(" of pump in 'it starts': SBR_0 "), std::string::npos) << text;
  EXPECT_NE(text.find("    look: s7200 debug pump.yaml --only 'it starts'\n      station pump; at "), std::string::npos)
      << text;
  const auto json = profile_summary_json(all.programs().front());
  EXPECT_EQ(json["worst_scan"]["scenario"], "it starts");
  EXPECT_FALSE(json.contains("instructions"));
  ProfileOfPrograms small;
  small.add(other, {});
  const std::string table = profile_by_run_text({{"it starts", &all}, {"it stops", &small}});
  EXPECT_NE(table.find("it stops"), std::string::npos) << table;
}

TEST(Profile, TextsFitAHundredColumns) {
  ProfileOfPrograms all;
  all.add(profile_of(kProgram, 3 * kSecond), {"", "a scenario", "s7200 debug x.yaml --only 'a scenario'"});
  const std::string text = profile_text(all.programs().front());
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    EXPECT_LE(end - at, 100U) << text.substr(at, end - at);
  }
}

TEST(Profile, DurationsKnowTheirShares) {
  Durations durations;
  for (Time each = 1; each <= 100; ++each) durations.add(each);
  EXPECT_EQ(durations.within(0.5), 50);
  EXPECT_EQ(durations.within(0.99), 99);
  EXPECT_EQ(durations.mean(), 50);
  EXPECT_EQ(Durations().within(0.5), 0);
}

TEST(Profile, BinsAreOfOneWidthWhereDurationsAreNearEachOther) {
  Durations durations;
  for (Time each = 1000; each < 1100; ++each) durations.add(each);
  const std::vector<Durations::Bin> bins = durations.histogram();
  ASSERT_EQ(bins.size(), 10U);
  EXPECT_EQ(bins.front(), (Durations::Bin{1000, 1010, 10}));
  EXPECT_EQ(bins.back(), (Durations::Bin{1090, 1100, 10}));
}

TEST(Profile, BinsWidenWithTheDurationsWhereTheyAreFarApart) {
  Durations durations;
  durations.add(0), durations.add(3), durations.add(199, 2), durations.add(200), durations.add(7000);
  const std::vector<Durations::Bin> wanted{{0, 1, 1}, {2, 5, 1}, {100, 200, 2}, {200, 500, 1}, {5000, 10000, 1}};
  EXPECT_EQ(durations.histogram(), wanted);
  EXPECT_TRUE(Durations().histogram().empty());
}

}  // namespace
}  // namespace s7200::tools::profile_test
