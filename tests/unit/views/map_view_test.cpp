// What `s7200 inspect PROGRAM map` shows.
#include "tools/views/inspection/map_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::map_view_test {
namespace {

using nlohmann::ordered_json;
using test::inspected;

ordered_json area(std::string_view stl, std::string_view name, const CpuModel& model = cpu214()) {
  const ordered_json map = map_json(inspected(stl, {}, model));
  for (const ordered_json& each : map["areas"])
    if (each["area"] == name) return each;
  return {};
}

TEST(MapView, NeighboursAreOneRangeAndTheRestIsFree) {
  const ordered_json v = area("LD SM0.0\nMOVB 1, VB0\nMOVW 1, VW1\nMOVB 1, VB9\nMEND\n", "V");
  EXPECT_EQ(v["memory"], "VB0 to VB4095");
  EXPECT_EQ(v["used"][0]["memory"], "VB0 to VB2");
  EXPECT_EQ(v["used"][1]["memory"], "VB9");
  EXPECT_EQ(v["free"], ordered_json::parse(R"(["VB3 to VB8", "VB10 to VB4095"])"));
}

TEST(MapView, BitsOfOutputsAreFreeOneByOne) {
  const ordered_json q = area("LD SM0.0\n= Q0.0\n= Q0.2\nMEND\n", "Q");
  EXPECT_EQ(q["free"][0], "Q0.1");
}

TEST(MapView, TellsWhichRoutinesUseWhat) {
  const ordered_json m = area("LD SM0.0\nCALL 1\n= M0.0\nMEND\nSBR 1\nLD M0.0\n= M0.1\nRET\n", "M");
  EXPECT_EQ(m["used"][0]["routines"], ordered_json::parse(R"(["MAIN", "SBR_1"])"));
  EXPECT_EQ(m["retentive"], ordered_json::parse(R"(["MB14 to MB31"])"));
}

TEST(MapView, TellsWhatOnlyRoutinesUseThatAreNeverExecuted) {
  constexpr std::string_view kProgram =
      "LD SM0.0\nMOVB 1, VB2\nMEND\nSBR 1\nLD SM0.0\nMOVD 0, VD0\nMOVB 1, VB9\nCALL 2\nRET\nSBR 2\nLD SM0.0\nMOVB 1, "
      "VB10\nRET\n";
  const ordered_json v = area(kProgram, "V");
  EXPECT_EQ(v["used"][0]["memory"], "VB0 to VB3");
  EXPECT_EQ(v["idle"], ordered_json::parse(R"([
    {"memory": "VB0 to VB1", "routines": ["SBR_1"]},
    {"memory": "VB3", "routines": ["SBR_1"]},
    {"memory": "VB9 to VB10", "routines": ["SBR_1", "SBR_2"]}])"));
  const std::string text = map_text(inspected(kProgram));
  EXPECT_NE(text.find("  used only by routines that are never executed: VB0 to VB1 (SBR_1), VB3 (SBR_1), "),
            std::string::npos)
      << text;
  EXPECT_EQ(area("LD SM0.0\nMOVB 1, VB2\nMEND\n", "V")["idle"], ordered_json::array());
}

TEST(MapView, BlocksAreUsedAsFarAsTheyReach) {
  EXPECT_EQ(area("LD SM0.0\nFILL 0, VW10, 5\nMEND\n", "V")["used"][0]["memory"], "VB10 to VB19");
}

TEST(MapView, AMessageIsAsLongAsItsConstantsAllow) {
  const std::string_view receives = "LD SM0.1\nMOVB 9, SMB30\n{}RCV VB500, 0\nMEND\n";
  const auto used = [&](std::string_view set) {
    return area(fmt::format(fmt::runtime(receives), set), "V", cpu224())["used"][0]["memory"];
  };
  EXPECT_EQ(used("MOVB 24, SMB94\n"), "VB500 to VB524");
  EXPECT_EQ(used("MOVB 24, SMB94\nMOVB 30, SMB94\n"), "VB500 to VB530");
  EXPECT_EQ(used("MOVB IB0, SMB94\n"), "VB500 to VB755");
  EXPECT_EQ(used(""), "VB500 to VB755");
}

std::vector<std::string> used(std::string_view stl, std::string_view name, const CpuModel& model) {
  std::vector<std::string> all;
  const ordered_json of = area(stl, name, model);
  for (const ordered_json& each : of["used"]) all.push_back(each["memory"]);
  return all;
}

TEST(MapView, AnInputOfAnEventOrOfACounterIsUsed) {
  constexpr std::string_view kProgram =
      "LD SM0.1\nATCH 0, 5\nHDEF 1, 4\nHSC 1\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n";
  EXPECT_EQ(used(kProgram, "I", *find_cpu("224")), (std::vector<std::string>{"I0.2", "I0.6 to I1.0"}));
  EXPECT_EQ(used(kProgram, "HC", *find_cpu("224")), (std::vector<std::string>{"HC1"}));
}

TEST(MapView, APulseOutputHasItsOwnSpecialMemory) {
  constexpr std::string_view kWidth = "LD SM0.1\nMOVB 16#CB, SMB77\nMOVW 9, SMW78\nPLS 1\nMOVW VW10, VW20\nMEND\n";
  for (const char* cpu : {"214", "224"}) {
    EXPECT_EQ(used(kWidth, "V", *find_cpu(cpu)), (std::vector<std::string>{"VB10 to VB11", "VB20 to VB21"})) << cpu;
    EXPECT_EQ(used(kWidth, "Q", *find_cpu(cpu)), (std::vector<std::string>{"Q0.1"})) << cpu;
  }
  for (const char* cpu : {"214", "224"})
    EXPECT_EQ(used(kWidth, "SM", *find_cpu(cpu)), (std::vector<std::string>{"SMB0", "SMB76 to SMB85"})) << cpu;
}

TEST(MapView, AProfileIsAsLongAsItsConstantsAllow) {
  constexpr std::string_view kProfile = "LD SM0.1\nMOVB 16#A0, SMB67\nMOVW 500, SMW168\n";
  const CpuModel& model = *find_cpu("224");
  EXPECT_EQ(used(std::string(kProfile) + "MOVB 3, VB500\nPLS 0\nMEND\n", "V", model),
            (std::vector<std::string>{"VB500 to VB524"}));
  const ordered_json open = area(std::string(kProfile) + "MOVB VB9, VB500\nPLS 0\nMEND\n", "V", model);
  EXPECT_EQ(open["perhaps"][0]["memory"], ordered_json::parse(R"(["VB501 to VB2540"])"));
  EXPECT_EQ(open["perhaps"][0]["through"][0]["pointer"], "SMW168");
}

TEST(MapView, PointersAreNamedWhereTheyMayLead) {
  const ordered_json v = area("LD SM0.0\nMOVD &VB100, AC1\nMOVB 1, *AC1\nMOVB 2, VB0\nMEND\n", "V");
  EXPECT_EQ(v["pointers"], ordered_json::parse(R"(["*AC1"])"));
  EXPECT_EQ(v["used"].size(), 1U);
}

TEST(MapView, NothingIsFreeThatAPointerMayReach) {
  const ordered_json table =
      area("LD SM0.0\nMOVD &VB100, AC1\nFOR VW0, 1, 4\nLD SM0.0\nMOVW 0, *AC1\n+D 2, AC1\nNEXT\nMEND\n", "V");
  EXPECT_EQ(table["free"], ordered_json::parse(R"(["VB2 to VB99", "VB108 to VB4095"])"));
  ASSERT_EQ(table["perhaps"].size(), 1U);
  EXPECT_EQ(table["perhaps"][0]["memory"], ordered_json::parse(R"(["VB100 to VB107"])"));
  EXPECT_EQ(table["perhaps"][0]["through"][0]["pointer"], "*AC1");
  EXPECT_EQ(table["perhaps"][0]["through"][0]["place"]["line"], 5);

  const std::string text = map_text(inspected("LD SM0.0\nMOVB 1, VB0\nMOVB 1, *VD8\nMEND\n"));
  EXPECT_NE(text.find("  perhaps used through *VD8 in test.stl:3: VB1 to VB7, VB12 to VB8191\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("free: VB"), std::string::npos) << "it may lead anywhere";
}

TEST(MapView, TimersHaveTheirResolutionAndTheirPresetAsATime) {
  const std::string text = map_text(inspected("LD I0.0\nTON T33, 25\nTON T37, VW0\nLD I0.0\nLD I0.1\nCTU C5, 12\nMEND\n"));
  EXPECT_NE(text.find("  T33   TON, 10 ms, 25 = 0.25 s"), std::string::npos) << text;
  EXPECT_NE(text.find("  T37   TON, 100 ms, VW0 "), std::string::npos) << text;
  EXPECT_NE(text.find("  C5    12 "), std::string::npos) << text;
}

TEST(MapView, NamesWhatSavesToEeprom) {
  const auto json = map_json(inspected("LD I0.0\nMOVB 16#81, SMB31\nMEND\n"));
  ASSERT_EQ(json["eeprom_savers"].size(), 1U);
  EXPECT_EQ(json["eeprom_savers"][0]["line"], 2);
}

TEST(MapView, KeepsToTheAreaOfAnAddress) {
  const std::string text = map_text(inspected("LD I0.0\n= Q0.0\nMOVB 1, VB0\nMEND\n", {"QB0"}));
  EXPECT_EQ(text.find("V: variable memory"), std::string::npos) << text;
  EXPECT_EQ(text.find("Q: outputs"), 0U) << text;
}

TEST(MapView, TextAndJsonKeepToWhatIsAskedFor) {
  constexpr std::string_view kProgram =
      "LD I0.0\nTON T33, 25\nTON T37, 5\nLD I0.0\nLD I0.1\nCTU C5, 12\nLD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nTON T38, 5\n"
      "MOVB 16#81, SMB31\nRET\n";
  const auto names = [&](const char* kind, const std::string& about) {
    const ordered_json map = map_json(inspected(kProgram, {about}));
    std::string all;
    for (const ordered_json& each : map[kind]) all += each["name"].get<std::string>() + " ";
    return all;
  };
  EXPECT_EQ(names("timers", "T37"), "T37 ");
  EXPECT_EQ(names("counters", "T37"), "");
  EXPECT_EQ(names("timers", "SBR_1"), "T38 ");
  EXPECT_EQ(names("counters", "C5"), "C5 ");
  EXPECT_EQ(map_json(inspected(kProgram, {"SBR_1"}))["eeprom_savers"].size(), 1U);
  EXPECT_EQ(map_json(inspected(kProgram, {"MAIN"}))["eeprom_savers"].size(), 0U);
  const std::string text = map_text(inspected(kProgram, {"T37"}));
  EXPECT_NE(text.find("  T37   TON, 100 ms, 5 = 0.5 s"), std::string::npos) << text;
  EXPECT_EQ(text.find("  T33   TON"), std::string::npos) << text;
  EXPECT_EQ(text.find("Counters"), std::string::npos) << text;
  EXPECT_NE(map_text(inspected(kProgram, {"SBR_1"})).find("EEPROM: "), std::string::npos);
}

}  // namespace
}  // namespace s7200::tools::map_view_test
