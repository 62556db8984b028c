// Why: what stands beside a record in a trace. Which line of the program did it, what an interrupt waited for, and what
// decided that a frame gets no answer.
//
// It must be told every record, in their order. Only what it has been told it knows: how long an instruction took and what
// decided takes every instruction too.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "interpreter/model/ports.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Of a CharacterIgnored or CharacterDropped: why nobody wanted it.
std::string ignored_because(const TraceRecord& record);

class TraceReasons {
 public:
  /// An instruction that takes longer is named wherever an interrupt has waited for it.
  static constexpr Time kLongInstruction = 200 * kMicrosecond;

  /// The program must live as long as this.
  explicit TraceReasons(const Program& program);

  /// `  line 82: DISI  // not now` of ATCH, DTCH, ENI, DISI, XMT, RCV and SMB30; `: DISI in line 82 until ENI in line 90` of
  /// an interrupt that waited; nothing of all else.
  std::string of(const TraceRecord& record);

  /// Of a ServiceBegin: that interrupts were disabled, which other routines ran, or a long instruction; nothing otherwise.
  std::string held_up_by(const TraceRecord& begin) const;

  /// Whether interrupts are disabled, and by what.
  struct Disabled {
    enum class By : std::uint8_t { Nothing, NoEni, Disi, Forgotten } by{};
    std::uint32_t disi = 0;  ///< of several in a row the first one
  };

  /// What decided that the program has come where it is.
  struct Cause {
    std::string text;         ///< `JMP 255 in line 141 (LDW= AC0, 0: AC0=16#7B06; NOT)`
    InstructionRecord by;     ///< the jump, or the last of the contacts
    InstructionRecord first;  ///< the same, or the first of the contacts
    bool contacts = false;    ///< that are in front of it in its own rung
    bool in_interrupt = false;
    std::vector<InstructionRecord> looked_at{};  ///< the contacts in front of the jump, or those of the rung
    std::string power{};  ///< `0`, `1`: the power flow behind each contact in the text, whatever values made it so
  };

  /// Characters that the program leaves without an answer: it attaches the routine again that got the first of them, or
  /// executes RCV again, and has sent nothing. Or it attaches another routine after one that has not read them: it waited
  /// for silence, or for its turn.
  struct Unanswered {
    std::size_t characters = 0;
    Time since = 0;          ///< start edge of the first
    Time until = 0;          ///< end of the last
    std::string decided_by;  ///< `JMP 255 in line 141 (LDW= AC0, 0: AC0=16#7B06; NOT)`, `INT 121 took them without reading
                             ///< SMB2 …`; nothing if it is not known
    std::optional<Cause> cause{};  ///< that; of characters that no routine has read the last ATCH of theirs, if there is one
    bool message_open = false;     ///< of taken(): RCV took them, and has not found the end of its message
    bool open = false;  ///< of taken(): what comes next goes the same way, nothing has been changed about that since
  };
  /// In the order in which they came.
  std::vector<Unanswered> unanswered(const TraceRecord& record) const;

  /// Those that no routine has read so far.
  std::vector<Unanswered> unread() const;

  /// Those since then that routines, or RCV, have taken and nothing has been sent for so far. What decided that is all that
  /// has kept the program from an XMT when it came by first after the last character: one without power flow, a jump over
  /// it, an end of a routine before it, a subroutine with it that was not called; without that, what the routine of the last
  /// character came by last.
  std::vector<Unanswered> taken(Time since) const;

  /// Of the place where the program is: the contacts of the rung so far, or the last jump or conditional end before it;
  /// nothing if the main program, or the interrupt routine, has met none so far.
  std::optional<Cause> cause() const;

  /// The contacts of the rung so far, with what they saw: `LD SM0.1: SM0.1=0`. Empty if it has none that decide anything.
  std::string contacts() const;

  /// This one has come; to be told after all that is asked about it.
  void note(const TraceRecord& record);
  void note(const InstructionRecord& record);

  /// What comes next need not follow on what has come; interrupts are so then.
  void forget(const Disabled& interrupts);
  void forget_instructions();

 private:
  struct Service {
    TraceRecord begin{};
    Time end = 0;
    std::uint8_t event = 0, routine = 0;
  };
  static constexpr std::size_t kServices = 32;  ///< more than all queues hold

  struct Enabled {
    TraceRecord record{};
    std::optional<Disabled> before{};
  };

  /// A jump, or a conditional end of a routine, and the contacts in front of it; or contacts of a rung, after which none has
  /// come so far. What it is in words is worked out when somebody asks.
  struct Decision {
    InstructionRecord by{};  ///< the last contact, if nothing has come after it
    std::vector<InstructionRecord> contacts{};
    bool in_interrupt = false;
    bool by_contacts = false;
  };
  /// A routine that is open.
  struct Way {
    std::vector<InstructionRecord> contacts{};  ///< of the rung so far
    bool decided = false;
    Decision decision{};  ///< the last one that has led here, if there was one
    Time called = 0;      ///< when it called another one

    /// As new, but keeps its room.
    void begin() {
      contacts.clear();
      decided = false;
      called = 0;
    }
  };
  /// The main program, or the interrupt routine that runs.
  struct Flow {
    Way way{};                   ///< of the innermost subroutine
    std::vector<Way> callers{};  ///< of those that wait for it

    void begin() {
      way.begin();
      callers.clear();
    }
  };
  /// Characters without a pause.
  struct Part {
    std::size_t characters = 0;
    std::size_t served = 0, lost = 0;  ///< of them: a routine got them, there was no room in the queue
    Time since = 0;
    std::uint8_t routine = 0;  ///< that got the last one
  };
  /// What came in at a port since the program has sent something, or has begun anew.
  struct Frame {
    std::size_t characters = 0;
    std::size_t unread = 0;  ///< of them: their routine does not look at the character
    Time since = 0, last = 0;
    std::uint8_t routine = 0;                     ///< that got its first character
    std::optional<std::uint32_t> attached_by{};   ///< the ATCH of that one
    std::optional<InstructionRecord> executed{};  ///< the last ATCH of a routine that got one of them, of another event
    bool read = true;                             ///< its last character: the routine that got it looks at it
    bool attached_anew = false;                   ///< another routine, or the same, since its last character
    bool passed_on = false;                       ///< and not by a routine that got one
    std::optional<Decision> cause{};              ///< that one of them was attached
    std::vector<Part> parts{};                    ///< the last ones, between pauses
    std::optional<Decision> led_by{};             ///< what the routine of the last one came by last
    std::vector<Decision> kept_by{};  ///< what has kept the program from each XMT first, since its last character
  };
  struct Reception {
    bool message_open = false;           ///< RCV is at work
    std::optional<TraceRecord> ended{};  ///< the ReceiveEnd of the last RCV
    Frame frame{};
    std::vector<Frame> earlier{};  ///< that another one followed before it was decided about them
    std::optional<std::uint32_t> attached_by{};
    std::optional<std::uint8_t> attached{};  ///< the routine that gets its characters; nothing: none, or it is not known
  };
  static constexpr std::size_t kEarlier = 8;

  struct Executed {
    Time at = 0, end = 0;
    std::uint32_t op = 0;
  };

  /// What an instruction is for a decision.
  enum class Role : std::uint8_t { Other, Contact, FirstContact, Mark, Jump, Call, Return, ConditionalEnd };

  const std::string& place_of(std::uint32_t op);
  std::string cause_of(const TraceRecord& begin) const;
  std::string disabled_text(const std::optional<Disabled>& before) const;
  void note_enable(const TraceRecord& record);
  std::string executed_meanwhile(const TraceRecord& begin) const;
  std::string executed_before(const TraceRecord& first, Time since) const;
  std::string line_of(std::uint32_t op) const;
  std::string text_of(const Decision& decision) const;
  std::string contacts_text(const std::vector<InstructionRecord>& contacts) const;
  std::string power_behind(const std::vector<InstructionRecord>& contacts) const;
  Unanswered unanswered(const Frame& frame, const std::optional<Cause>& cause) const;
  std::optional<Unanswered> taken(const Reception& reception, Time since) const;
  bool is_own(const InstructionRecord& contact) const;
  bool has_own_contacts(const Way& way) const;
  void decide(Flow& flow, const InstructionRecord& by) const;
  void call(Flow& flow, const InstructionRecord& by) const;
  static void return_to_caller(Flow& flow);
  const Flow& flow() const { return in_interrupt_ ? interrupt_ : main_; }
  bool is_decided() const { return flow().way.decided || has_own_contacts(flow().way); }
  std::optional<Decision> decision() const;
  Cause cause_of(const Decision& decision) const;
  std::optional<Cause> cause_of(const std::optional<Decision>& decision) const;
  std::optional<Cause> cause_of(const Frame& frame) const;
  std::optional<Cause> cause_of_leaving(const Reception& reception, const TraceRecord& record) const;
  Cause received_again(const Reception& reception, const TraceRecord& record) const;
  void note_transmit_passed(const Flow& flow, const InstructionRecord& by);
  bool serves_character() const { return in_interrupt_ && is_receive_event(serving_); }
  bool goes_on(const Frame& frame, const TraceRecord& record) const;
  bool is_left(const Frame& frame, const TraceRecord& record) const;
  bool is_attached_already(const TraceRecord& record) const;
  std::string unread_text(const Frame& frame) const;
  void note_character(const TraceRecord& record);
  void note_event(const TraceRecord& record);
  void note_restart(const TraceRecord& record);
  void note_end_of_service();
  void note_reception(const TraceRecord& record);

  const Program& program_;
  std::unordered_map<std::uint32_t, std::string> places_;  ///< by op, as far as they have come
  std::vector<Role> role_;                                 ///< by op
  std::optional<Disabled> disabled_;                       ///< nothing: not known
  std::optional<Enabled> enabled_;                         ///< by the last ENI, if they may have been disabled before it
  std::deque<Service> services_;                           ///< the last, newest last
  std::optional<Executed> last_;
  bool in_interrupt_ = false, interrupt_ends_ = false;
  bool failed_ = false;       ///< the instruction being executed has caused a run-time error
  std::uint8_t serving_ = 0;  ///< event, in an interrupt
  TraceRecord begun_{};       ///< the last ServiceBegin
  Flow main_, interrupt_;
  std::array<Reception, kPorts.size()> reception_{};
  std::bitset<128> reads_character_{};           ///< interrupt routines, by number
  std::vector<std::uint8_t> passes_transmit_{};  ///< by op, ports, a bit each: it may keep the program from an XMT to them
};

}  // namespace s7200
