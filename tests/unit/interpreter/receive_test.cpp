// RCV, facts 10.3: every start condition, every end, times, errors, the open choices; and random streams of characters
// against a second model, written from the rules alone.
#include <fmt/ranges.h>

#include <deque>
#include <random>

#include "interpreter/cpu/ports/message_receiver.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::receive_test {
namespace {

using enum TraceKind;

// Bits of SMB87 and SMB86.
constexpr int kEn = 0x80, kSc = 0x40, kEc = 0x20, kIl = 0x10, kCm = 0x08, kTmr = 0x04, kBk = 0x02;
constexpr int kN = 0x80, kR = 0x40, kE = 0x20, kT = 0x04, kC = 0x02, kP = 0x01;

struct Parameters {
  int control = kEn | kIl, start = 0x3A, end = 0x0D, idle = 0, timeout = 0, most = 20;
};

/// A CPU 224 whose model has other choices; it lives as long as the tests.
const CpuModel& with(const std::function<void(ReceiveChoices&)>& choose) {
  static std::deque<CpuModel> models;
  choose(models.emplace_back(cpu224()).receive);
  return models.back();
}

/// Port 0 in Freeport mode; VW10 counts event 23, VW12 event 8. The table of RCV is at VB100.
class Receiver : public Plc {
 public:
  explicit Receiver(const CpuModel& model = cpu224(), std::string_view main = "")
      : Plc(fmt::format("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 23\nATCH 1, 8\nENI\n{}MEND\n"
                        "INT 0\nINCW VW10\nRETI\nINT 1\nINCW VW12\nRETI\n",
                        main),
            model) {
    run_until(1 * ms);
  }

  Time set_up(const Parameters& p) {
    set("SMB87", static_cast<std::uint32_t>(p.control));
    set("SMB88", static_cast<std::uint32_t>(p.start));
    set("SMB89", static_cast<std::uint32_t>(p.end));
    set("SMW90", static_cast<std::uint32_t>(p.idle));
    set("SMW92", static_cast<std::uint32_t>(p.timeout));
    set("SMB94", static_cast<std::uint32_t>(p.most));
    return cpu.time();
  }
  /// When RCV was executed.
  Time rcv(const char* table = "VB100") {
    message_receiver::receive(cpu.core(), 0, place(table).at);
    return cpu.time();
  }
  Time rcv(const Parameters& p) {
    set_up(p);
    return rcv();
  }

  void hear(Time end, int byte) { received_at({.byte = static_cast<std::uint8_t>(byte), .end = end}); }
  void hear_bad(Time end, int byte) {
    received_at({.byte = static_cast<std::uint8_t>(byte), .parity_error = true, .end = end});
  }
  void hear_break(Time end) { received_at({.framing_error = true, .end = end, .line_break = true}); }

  int status() const { return static_cast<int>(value("SMB86")); }
  Ints stored() const {
    Ints bytes;
    for (std::int64_t i = 1; i <= value("VB100"); ++i)
      bytes.push_back(static_cast<int>(value(fmt::format("VB{}", 100 + i))));
    return bytes;
  }
  /// When it ended; 0 if it goes on.
  Time ended() const {
    const Times times = records.times(ReceiveEnd);
    return times.empty() ? 0 : times.back();
  }
};

// --- start ---

// What comes, with the milliseconds since RCV: x5 at 1, colon 3A at 2, x6 at 3, then 8 ms of silence, x7 at 11, colon at 12,
// x8 at 13, a break at 14, x9 at 15, colon at 16, a break at 17, colon at 18, xA at 19. Idle time, if any: 5 ms.
TEST(Receive, EachStartConditionTakesItsFirstCharacter) {
  struct Case {
    int control, idle;
    Ints stored;
  };
  const Ints all{5, 0x3A, 6, 7, 0x3A, 8};
  const Case cases[] = {
      {kIl, 5, {7, 0x3A, 8}},           // after the silence
      {kIl, 0, all},                    // any character
      {kSc, 5, {0x3A, 6, 7, 0x3A, 8}},  // from the first start character on
      {kIl | kSc, 5, {}},               // x7 follows the silence, so the search begins again
      {kIl | kSc, 0, {0x3A, 6, 7, 0x3A, 8}},
      {kBk, 5, {9, 0x3A}},
      {kSc | kBk, 5, {0x3A, 10}},  // x9 follows the first break, so another break is needed
      {kIl | kBk, 5, {7, 0x3A, 8}},
      {kIl | kBk, 0, all},
      {kIl | kSc | kBk, 5, {0x3A, 10}},
      {kIl | kSc | kBk, 0, {0x3A, 6, 7, 0x3A, 8}},
  };
  for (const Case& c : cases) {
    Receiver plc;
    const Time t0 = plc.rcv({.control = kEn | c.control, .idle = c.idle}) + 1;
    int at[] = {1, 2, 3, 11, 12, 13, 14, 15, 16, 17, 18, 19}, byte[] = {5, 0x3A, 6, 7, 0x3A, 8, -1, 9, 0x3A, -1, 0x3A, 10};
    for (std::size_t i = 0; i < std::size(at); ++i) {
      if (byte[i] < 0)
        plc.hear_break(t0 + at[i] * ms);
      else
        plc.hear(t0 + at[i] * ms, byte[i]);
    }
    plc.run_until(t0 + 30 * ms);
    EXPECT_EQ(plc.stored(), c.stored) << "control " << c.control << ", idle time " << c.idle;
    const bool breaks_in = !c.stored.empty() && c.stored.back() != 10;  // a break inside the message ends it
    EXPECT_EQ(plc.status(), breaks_in ? kP : 0) << "control " << c.control << ", idle time " << c.idle;
  }
}

TEST(Receive, AfterTheSilenceTheStartCharacterMustBeTheNext) {
  Receiver plc;
  const Time t0 = plc.rcv({.control = kEn | kIl | kSc, .idle = 5}) + 1;
  plc.hear(t0 + 1 * ms, 0x3A);  // no silence yet
  plc.hear(t0 + 8 * ms, 7);
  plc.hear(t0 + 9 * ms, 0x3A);
  plc.hear(t0 + 16 * ms, 0x3A);
  plc.hear(t0 + 17 * ms, 8);
  plc.run_until(t0 + 20 * ms);
  EXPECT_EQ(plc.stored(), (Ints{0x3A, 8}));
}

TEST(Receive, TheIdleTimeRunsToTheEndOfACharacter) {
  for (const Time start : {4 * ms, 7 * ms}) {
    Receiver plc;
    const Time t0 = plc.rcv({.control = kEn | kIl, .idle = 5});
    plc.received_at({.byte = 1, .start = t0 + start, .end = t0 + 8 * ms + 1});
    plc.run_until(t0 + 20 * ms);
    EXPECT_EQ(plc.stored(), Ints{1}) << "when the character began does not matter";
  }
}

TEST(Receive, IdleLineOrBreakWhicheverComesFirst) {
  const CpuModel& both = with([](ReceiveChoices& c) { c.idle_or_break = false; });
  for (const bool silent : {false, true})
    for (const bool broken : {false, true}) {
      for (const CpuModel* model : {&cpu224(), &both}) {
        Receiver plc(*model);
        const Time t0 = plc.rcv({.control = kEn | kIl | kBk, .idle = 5}) + 1;
        const Time before = silent ? 8 * ms : 1 * ms;
        if (broken) plc.hear_break(t0 + before);
        plc.hear(t0 + before + 1 * ms, 1);
        plc.run_until(t0 + 12 * ms);
        EXPECT_EQ(plc.stored().size(), (model == &both ? silent && broken : silent || broken) ? 1u : 0u);
      }
    }
}

TEST(Receive, ABadCharacterIsNotAStartCharacter) {
  Receiver plc;
  const Time t0 = plc.rcv({.control = kEn | kSc});
  plc.hear_bad(t0 + 1 * ms, 0x3A);
  plc.hear(t0 + 2 * ms, 0x3A);
  plc.run_until(t0 + 5 * ms);
  EXPECT_EQ(plc.stored(), Ints{0x3A});
  EXPECT_EQ(plc.status(), 0);
  EXPECT_EQ(plc.records.of(CharacterDropped).size(), 1u);
}

TEST(Receive, ABreakBeforeTheMessageIsDropped) {
  Receiver plc;
  const Time t0 = plc.rcv(Parameters{});
  plc.hear_break(t0 + 1 * ms);
  plc.hear(t0 + 2 * ms, 1);
  plc.run_until(t0 + 5 * ms);
  EXPECT_EQ(plc.stored(), Ints{1});
  EXPECT_EQ(plc.status(), 0);
}

// On the CPUs 215 and 216 bit 1 of the control byte means nothing (C79000-G7000-C230-02, table D-16).
TEST(Receive, TheCpus215And216HaveNoStartByBreak) {
  for (const CpuModel* model : {&cpu215(), &cpu216()}) {
    Receiver alone(*model);
    alone.rcv({.control = kEn | kBk});
    EXPECT_EQ(alone.status(), kR);
    Receiver plc(*model);
    const Time t0 = plc.rcv({.control = kEn | kSc | kBk});
    plc.hear(t0 + 1 * ms, 0x3A);
    plc.run_until(t0 + 3 * ms);
    EXPECT_EQ(plc.stored(), Ints{0x3A});
  }
}

TEST(Receive, CpusBeforeThe215HaveNoRcv) {
  for (const CpuModel* model : {&cpu212(), &cpu214()}) {
    const CheckResult result = check_text("LD SM0.0\nRCV VB0, 0\nMEND\n", "t", *model, easy_times());
    EXPECT_EQ(result.diagnostics.at(0).message, fmt::format("CPU {} has no RCV", model->name));
  }
}

// --- end ---

TEST(Receive, EachEndHasItsStatusAndCausesEvent23) {
  struct Case {
    Parameters parameters;
    Ints sent;
    int status;
    Ints stored;
  };
  const Case cases[] = {
      {{.control = kEn | kIl | kEc}, {1, 2, 0x0D, 3}, kE, {1, 2, 0x0D}},
      {{.control = kEn | kIl, .most = 3}, {1, 2, 0x0D, 3}, kC, {1, 2, 0x0D}},
      {{.control = kEn | kSc | kEc, .most = 1}, {1, 0x3A, 3}, kC, {0x3A}},
      {{.control = kEn | kIl | kTmr, .timeout = 4}, {1, 2}, kT, {1, 2}},
      {{.control = kEn | kIl | kTmr | kCm, .timeout = 4}, {1, 2}, kT, {1, 2}},
      {{.control = kEn | kIl, .most = 255}, {1, 2, -3}, kP, {1, 2}},
  };
  for (const Case& c : cases) {
    Receiver plc;
    Time at = plc.rcv(c.parameters) + 1;
    for (const int byte : c.sent) {
      at += 1 * ms;
      if (byte < 0)
        plc.hear_bad(at, -byte);
      else
        plc.hear(at, byte);
    }
    plc.run_until(at + 20 * ms);
    EXPECT_EQ(plc.status(), c.status);
    EXPECT_EQ(plc.stored(), c.stored);
    EXPECT_EQ(plc.value("VW10"), 1) << "event 23";
    EXPECT_EQ(plc.records.of(ReceiveEnd).size(), 1u);
  }
}

TEST(Receive, EndCharacterAndCountTogetherSetBothBits) {
  const CpuModel& one = with([](ReceiveChoices& c) { c.end_and_count = false; });
  for (const CpuModel* model : {&cpu224(), &one}) {
    Receiver plc(*model);
    const Time t0 = plc.rcv({.control = kEn | kIl | kEc, .most = 2});
    plc.hear(t0 + 1 * ms, 1);
    plc.hear(t0 + 2 * ms, 0x0D);
    plc.run_until(t0 + 5 * ms);
    EXPECT_EQ(plc.status(), model == &one ? kE : kE | kC);
    EXPECT_EQ(plc.value("VW10"), 1);
  }
}

TEST(Receive, TheStartCharacterIsNotTheEnd) {
  const CpuModel& may = with([](ReceiveChoices& c) { c.start_may_end = true; });
  for (const CpuModel* model : {&cpu224(), &may}) {
    Receiver plc(*model);
    const Time t0 = plc.rcv({.control = kEn | kSc | kEc, .start = 0x2A, .end = 0x2A});
    plc.hear(t0 + 1 * ms, 0x2A);
    plc.hear(t0 + 2 * ms, 1);
    plc.hear(t0 + 3 * ms, 0x2A);
    plc.run_until(t0 + 5 * ms);
    EXPECT_EQ(plc.status(), kE);
    EXPECT_EQ(plc.stored(), model == &may ? Ints{0x2A} : (Ints{0x2A, 1, 0x2A}));
  }
}

TEST(Receive, AnEndCharacterMayBeTheFirstOneAfterTheSilence) {
  Receiver plc;
  const Time t0 = plc.rcv({.control = kEn | kIl | kEc});
  plc.hear(t0 + 1 * ms, 0x0D);
  plc.run_until(t0 + 3 * ms);
  EXPECT_EQ(plc.status(), kE);
}

TEST(Receive, ABadCharacterEndsTheMessageAndIsNotStored) {
  const CpuModel& stores = with([](ReceiveChoices& c) { c.stores_bad_character = true; });
  for (const CpuModel* model : {&cpu224(), &stores}) {
    Receiver plc(*model);
    const Time t0 = plc.rcv({.control = kEn | kIl | kEc, .end = 9});
    plc.hear(t0 + 1 * ms, 1);
    plc.hear_bad(t0 + 2 * ms, 9);
    plc.run_until(t0 + 5 * ms);
    EXPECT_EQ(plc.status(), kP) << "the error comes before the end character";
    EXPECT_EQ(plc.stored(), model == &stores ? (Ints{1, 9}) : Ints{1});
  }
  Receiver first;
  const Time t0 = first.rcv(Parameters{});
  first.hear_bad(t0 + 1 * ms, 1);
  first.run_until(t0 + 3 * ms);
  EXPECT_EQ(first.status(), kP) << "the start condition is met";
}

TEST(Receive, ABreakInsideTheMessageEndsIt) {
  Receiver plc;
  const Time t0 = plc.rcv(Parameters{});
  plc.hear(t0 + 1 * ms, 1);
  plc.hear_break(t0 + 2 * ms);
  plc.run_until(t0 + 5 * ms);
  EXPECT_EQ(plc.status(), kP);
  EXPECT_EQ(plc.stored(), Ints{1});
}

// --- times ---

TEST(Receive, TimesEndAtTheFirstTickOfTheClockAtWhichTheyHavePassed) {
  for (const int timeout : {0, 1, 4})
    for (const Time late : {Time{1}, 500 * us, ms - 1}) {
      Receiver plc;
      plc.rcv({.control = kEn | kIl | kTmr, .timeout = timeout});
      const Time last = 5 * ms + late;
      plc.hear(last, 1);
      plc.run_until(20 * ms);
      EXPECT_EQ(plc.ended(), (6 + timeout) * ms) << timeout << ' ' << late;
    }
  Receiver on_tick;
  on_tick.rcv({.control = kEn | kIl | kTmr, .timeout = 4});
  on_tick.hear(5 * ms, 1);
  on_tick.run_until(20 * ms);
  EXPECT_EQ(on_tick.ended(), 9 * ms);
}

TEST(Receive, TheTimeBetweenCharactersStartsAgainWithEach) {
  Receiver plc;
  plc.rcv({.control = kEn | kIl | kTmr, .timeout = 3});
  for (const Time at : {4 * ms, 6 * ms, 8 * ms}) plc.hear(at + 1, 1);
  plc.run_until(30 * ms);
  EXPECT_EQ(plc.stored().size(), 3u);
  EXPECT_EQ(plc.ended(), 12 * ms);
}

TEST(Receive, TheTimeOfTheMessageStartsWithItsFirstCharacter) {
  Receiver plc;
  plc.rcv({.control = kEn | kSc | kTmr | kCm, .timeout = 5});
  plc.hear(8 * ms + 1, 0x3A);
  for (const Time at : {10 * ms, 12 * ms, 15 * ms}) plc.hear(at + 1, 1);
  plc.run_until(30 * ms);
  EXPECT_EQ(plc.stored().size(), 3u);
  EXPECT_EQ(plc.ended(), 14 * ms);
}

TEST(Receive, OnlyWithAnyCharacterTheTimeOfTheMessageEndsItWithoutOne) {
  for (const int start : {kIl, kSc, kIl | kSc, kBk})
    for (const int idle : {0, 3}) {
      Receiver plc;
      const Time t0 = plc.rcv({.control = kEn | start | kTmr | kCm, .idle = idle, .timeout = 5});
      plc.run_until(100 * ms);
      const bool any = start == kIl && idle == 0;
      EXPECT_EQ(plc.status(), any ? kT : 0);
      EXPECT_EQ(plc.ended(), any ? (t0 + 6 * ms - 1) / ms * ms : 0);
      EXPECT_EQ(plc.value("VB100"), 0);
      EXPECT_EQ(plc.value("VW10"), any ? 1 : 0);
    }
}

// --- RCV itself ---

TEST(Receive, TheParametersAreThoseOfTheMomentOfRcv) {
  Receiver plc;
  const Time t0 = plc.rcv({.control = kEn | kIl | kEc | kTmr, .timeout = 5, .most = 10});
  plc.set_up({.control = 0, .start = 0, .end = 1, .idle = 9, .timeout = 1, .most = 1});
  plc.hear(t0 + 2 * ms, 1);
  plc.hear(t0 + 4 * ms, 2);
  plc.hear(t0 + 6 * ms, 0x0D);
  plc.run_until(t0 + 10 * ms);
  EXPECT_EQ(plc.stored(), (Ints{1, 2, 0x0D}));
  EXPECT_EQ(plc.status(), kE);
}

TEST(Receive, TheNumberInTheTableGrows) {
  Receiver plc;
  plc.set("VB100", 77);
  const Time t0 = plc.rcv(Parameters{});
  EXPECT_EQ(plc.value("VB100"), 0);
  plc.hear(t0 + 1 * ms, 1);
  plc.hear(t0 + 2 * ms, 2);
  plc.run_until(t0 + 1500 * us);
  EXPECT_EQ(plc.value("VB100"), 1);
  plc.run_until(t0 + 3 * ms);
  EXPECT_EQ(plc.value("VB100"), 2);
}

TEST(Receive, TheUserEndsItWithoutEvent) {
  const CpuModel& tells = with([](ReceiveChoices& c) { c.event_after_user_end = true; });
  for (const CpuModel* model : {&cpu224(), &tells}) {
    Receiver plc(*model);
    const Time t0 = plc.rcv({.control = kEn | kIl | kTmr, .timeout = 5});
    plc.hear(t0 + 1 * ms, 1);
    plc.run_until(t0 + 2 * ms);
    plc.set("SMB87", kIl);
    plc.rcv();
    EXPECT_EQ(plc.status(), kN);
    EXPECT_EQ(plc.stored(), Ints{1});
    plc.run_until(t0 + 20 * ms);
    EXPECT_EQ(plc.status(), kN) << "the time no longer runs";
    EXPECT_EQ(plc.value("VW10"), model == &tells ? 1 : 0);
    EXPECT_TRUE(plc.records.errors().empty());
  }
}

TEST(Receive, RcvThatIsNotEnabledSetsOnlyItsStatus) {
  Receiver plc;
  plc.set("VB100", 77);
  plc.rcv({.control = kIl});
  EXPECT_EQ(plc.status(), kN);
  EXPECT_EQ(plc.value("VB100"), 77);
  EXPECT_TRUE(plc.records.errors().empty());
}

TEST(Receive, WithoutAStartConditionOrRoomItIsRefusedInTheStatus) {
  const CpuModel& tells = with([](ReceiveChoices& c) { c.event_after_bad_parameters = true; });
  for (const CpuModel* model : {&cpu224(), &tells})
    for (const Parameters& p : {Parameters{.control = kEn | kEc | kTmr | kCm, .timeout = 5}, {.most = 0}}) {
      Receiver plc(*model);
      const Time t0 = plc.rcv(p);
      EXPECT_EQ(plc.status(), kR);
      plc.hear(t0 + 1 * ms, 1);
      plc.run_until(t0 + 20 * ms);
      EXPECT_EQ(plc.value("VB100"), 0);
      EXPECT_EQ(plc.value("VW10"), model == &tells ? 1 : 0);
      EXPECT_EQ(plc.value("VW12"), 1) << "the character belongs to event 8";
      EXPECT_TRUE(plc.records.errors().empty());
    }
}

TEST(Receive, ATableWithoutRoomIs0091) {
  Receiver plc;
  plc.set_up({.most = 20});
  plc.rcv("VB8172");
  EXPECT_EQ(plc.records.errors(), Ints{0x91});
  plc.rcv("VB8171");
  EXPECT_EQ(plc.records.errors(), Ints{0x91});
  EXPECT_EQ(plc.records.of(Receive).size(), 1u);
}

TEST(Receive, WithoutFreeportModeItIs0009) {
  Receiver plc;
  plc.set("SMB30", 8);
  plc.rcv(Parameters{});
  EXPECT_EQ(plc.records.errors(), Ints{9});
}

// The running service goes on.
TEST(Receive, XmtAndRcvExcludeEachOtherInAllFourPairs) {
  for (const char* first : {"XMT VB50, 0", "RCV VB100, 0"})
    for (const char* second : {"XMT VB50, 0", "RCV VB100, 0"}) {
      Receiver plc(cpu224(), fmt::format("LD V0.0\nEU\n{}\n{}\n", first, second));
      plc.set_up(Parameters{.most = 1});
      plc.set("VB50", 1);
      plc.set("VB0", 1);
      plc.hear(8 * ms, 7);
      plc.run_until(20 * ms);
      EXPECT_EQ(plc.records.errors(), Ints{9}) << first << ' ' << second;
      const bool sent = first[0] == 'X';
      EXPECT_EQ(plc.port.sent.size(), sent ? 1u : 0u);
      EXPECT_EQ(plc.status(), sent ? 0 : kC);
    }
}

TEST(Receive, WhileSendingItCannotBeEndedEither) {
  Receiver plc(cpu224(), "LD V0.0\nEU\nXMT VB50, 0\nRCV VB100, 0\n");
  plc.set("VB50", 1);
  plc.set("VB0", 1);
  plc.run_until(3 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{9});
}

// The idiom of masters: the routine of transmit complete starts to receive.
TEST(Receive, AfterTransmitCompleteItReceives) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#90, SMB87\nMOVB 2, SMB94\nMOVB 1, VB50\nATCH 0, 9\nENI\nXMT VB50, 0\nMEND\n"
      "INT 0\nRCV VB100, 0\nRETI\n",
      cpu224());
  plc.received_at({.byte = 1, .end = 5 * ms});
  plc.received_at({.byte = 2, .end = 6 * ms});
  plc.run_until(8 * ms);
  EXPECT_TRUE(plc.records.errors().empty());
  EXPECT_EQ(plc.value("VB100"), 2);
  EXPECT_EQ(plc.value("SMB86"), kC);
}

TEST(Receive, TheCharacterEventIsNotRaisedWhileItReceives) {
  const CpuModel& raises = with([](ReceiveChoices& c) { c.character_events = true; });
  for (const CpuModel* model : {&cpu224(), &raises}) {
    Receiver plc(*model);
    Time at = plc.rcv({.control = kEn | kSc, .most = 2});
    for (const int byte : {1, 0x3A, 2, 3}) plc.hear(at += ms, byte);
    plc.run_until(at + 3 * ms);
    EXPECT_EQ(plc.value("VW12"), model == &raises ? 4 : 1);
    EXPECT_EQ(plc.value("VW10"), 1);
  }
}

TEST(Receive, StopEndsItSilently) {
  Receiver plc(cpu224(), "LD I0.0\nSTOP\n");
  plc.rcv({.control = kEn | kIl | kTmr | kCm, .timeout = 10});
  plc.input_at(4 * ms, "I0.0", true);
  plc.run_until(30 * ms);
  EXPECT_TRUE(plc.stopped());
  EXPECT_EQ(plc.status(), 0);
  EXPECT_TRUE(plc.records.of(ReceiveEnd).empty());
}

TEST(Receive, LeavingFreeportModeEndsItSilently) {
  Receiver plc;
  const Time t0 = plc.rcv({.control = kEn | kIl | kTmr | kCm, .timeout = 10});
  plc.set("SMB30", 8);
  plc.run_until(t0 + 20 * ms);
  EXPECT_EQ(plc.status(), 0);
  EXPECT_TRUE(plc.records.of(ReceiveEnd).empty());
  plc.set("SMB30", 9);
  plc.rcv(Parameters{});
  EXPECT_TRUE(plc.records.errors().empty()) << "it is not receiving any more";
}

TEST(Receive, AnotherRateInFreeportModeDoesNotEndIt) {
  Receiver plc;
  const Time t0 = plc.rcv(Parameters{.most = 1});
  plc.set("SMB30", 5);
  plc.hear(t0 + 1 * ms, 1);
  plc.run_until(t0 + 2 * ms);
  EXPECT_EQ(plc.status(), kC);
}

// --- random streams against a second model ---

struct Heard {
  Time end = 0;
  int byte = 0;
  bool bad = false, is_break = false;
};

struct Outcome {
  int status = 0;  // 0: it goes on
  Time at = 0;
  Ints stored{};
  bool operator==(const Outcome&) const = default;
};

/// Counts the ticks one by one.
Time alarm(Time from, int milliseconds) {
  Time tick = from - from % ms + ms;
  if (from % ms == 0 && milliseconds > 0) tick = from;
  while (tick - from < milliseconds * ms) tick += ms;
  return tick;
}

/// Looks at the stream as a whole, with the table of start conditions as facts 10.3 print it.
std::size_t first_of_message(const Parameters& p, Time rcv, const std::vector<Heard>& heard) {
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const Heard& now = heard[i];
    if (now.is_break) continue;
    const bool silence = p.idle == 0 || alarm(i == 0 ? rcv : heard[i - 1].end, p.idle) < now.end;
    const bool after_break = i > 0 && heard[i - 1].is_break;
    const bool is_start = !now.bad && now.byte == p.start;
    bool first = false;
    switch (p.control & (kIl | kSc | kBk)) {
      case kIl:
        first = silence;
        break;
      case kSc:
        first = is_start;
        break;
      case kIl | kSc:
        first = silence && is_start;
        break;
      case kBk:
        first = after_break;
        break;
      case kSc | kBk:
        first = after_break && is_start;
        break;
      case kIl | kBk:
        first = silence || after_break;
        break;
      case kIl | kSc | kBk:
        first = (silence || after_break) && is_start;
        break;
    }
    if (first) return i;
  }
  return heard.size();
}

Outcome expected(const Parameters& p, Time rcv, const std::vector<Heard>& heard) {
  const bool timed = p.control & kTmr, whole = p.control & kCm;
  const bool any_character = (p.control & kIl) && !(p.control & kSc) && p.idle == 0;
  const std::size_t first = first_of_message(p, rcv, heard);
  Outcome outcome;
  Time deadline = timed && whole && any_character ? alarm(rcv, p.timeout) : kNever;
  for (std::size_t i = first;; ++i) {
    if (deadline != kNever && (i >= heard.size() || heard[i].end > deadline)) {
      outcome.status = kT;
      outcome.at = deadline;
      return outcome;
    }
    if (i >= heard.size()) return outcome;
    outcome.at = heard[i].end;
    if (heard[i].bad || heard[i].is_break) {
      outcome.status = kP;
      return outcome;
    }
    outcome.stored.push_back(heard[i].byte);
    const bool is_the_start = i == first && (p.control & kSc);
    if ((p.control & kEc) && heard[i].byte == p.end && !is_the_start) outcome.status |= kE;
    if (static_cast<int>(outcome.stored.size()) >= p.most) outcome.status |= kC;
    if (outcome.status != 0) return outcome;
    outcome.at = 0;
    if (timed && (!whole || (i == first && !any_character))) deadline = alarm(heard[i].end, p.timeout);
  }
}

TEST(Receive, RandomStreamsAreReceivedAsASecondModelSays) {
  std::mt19937 random(20240611);
  const auto any = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most + 1)); };
  std::map<int, int> statuses;
  for (int round = 0; round < 3000; ++round) {
    const int combination = 1 + any(6);
    const int start = (combination & 1 ? kIl : 0) | (combination & 2 ? kSc : 0) | (combination & 4 ? kBk : 0);
    const Parameters p{.control = kEn | start | (any(1) ? kEc : 0) | (any(1) ? kTmr : 0) | (any(1) ? kCm : 0),
                       .start = 1,
                       .end = any(2),
                       .idle = any(1) * any(6),
                       .timeout = any(9),
                       .most = 1 + any(7)};
    Receiver plc;
    const Time rcv = plc.rcv(p);
    std::vector<Heard> heard;
    Time at = rcv;
    for (int i = any(14); i > 0; --i) {
      at += 1 * ms + any(any(3) ? 1 : 8) * ms + any(999) * us;
      at += at % ms == 0 ? 1 : 0;  // not at a tick: what comes first then is a matter of the order of events
      const bool is_break = any(5) == 0;
      heard.push_back({.end = at, .byte = any(3), .bad = !is_break && any(15) == 0, .is_break = is_break});
      if (is_break)
        plc.hear_break(at);
      else if (heard.back().bad)
        plc.hear_bad(at, heard.back().byte);
      else
        plc.hear(at, heard.back().byte);
    }
    plc.run_until(at + 30 * ms);
    const Outcome found{plc.status(), plc.status() ? plc.ended() : 0, plc.stored()};
    const Outcome wanted = expected(p, rcv, heard);
    ASSERT_EQ(found, wanted) << fmt::format(
        "round {}: control {:02X}, end {}, idle {}, time {}, most {}; status {:02X} for {:02X}", round, p.control, p.end,
        p.idle, p.timeout, p.most, found.status, wanted.status);
    ++statuses[found.status];
  }
  for (const int status : {0, kE, kC, kT, kP, kE | kC}) EXPECT_GE(statuses[status], 20) << status;
}

}  // namespace
}  // namespace s7200::test::receive_test
