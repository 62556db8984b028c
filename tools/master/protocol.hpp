// The interface of a protocol for a master. Each protocol is a file of its own that implements it, and a row in
// protocols.cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/peers/answer.hpp"
#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::tools {

/// A request, and what answers to it mean, in the protocol's own terms.
class ProtocolRequest {
 public:
  virtual ~ProtocolRequest() = default;

  /// The next frame to send. Mostly the same each time.
  virtual serial::Frame frame() = 0;

  /// The next step of a request in several steps, after this answer to the last step, `elapsed` after the end of the first.
  /// Nothing when the request is over. An exchange then has the characters of all steps.
  virtual std::optional<serial::Frame> next(std::span<const std::uint8_t> /*response*/, Time /*elapsed*/) { return {}; }

  /// Whether anything comes after the step that was sent last.
  virtual bool answered() const { return true; }

  /// The line has a sync signal, which is high while the request is sent.
  virtual bool with_sync() const { return false; }

  /// How long the line is left to the slaves after a broadcast, which none answers; nothing for any other request.
  virtual std::optional<Time> turnaround() const { return {}; }

  virtual serial::Answer judge(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) const = 0;

  /// The meaning of a refusal's code: `illegal data address`.
  virtual std::string_view error_name(std::uint16_t code) const = 0;

  /// The meaning of a refusal's code together with the code.
  virtual std::string error_text(std::uint16_t code) const { return serial::error_text(code, error_name(code)); }

  /// The station and the data that are asked for: `station 1, function 3, holding registers 10…11`. Empty for a raw frame.
  virtual std::string subject() const = 0;

  /// The content of a right answer: in one line, and in a line for each value with its address. `response` is not empty.
  virtual std::string in_short(const serial::Answer& answer, std::span<const std::uint8_t> request,
                               std::span<const std::uint8_t> response) const = 0;
  virtual std::vector<std::string> in_lines(const serial::Answer& answer, std::span<const std::uint8_t> request,
                                            std::span<const std::uint8_t> response) const = 0;

  /// The keys from `station` to `count` of the JSON, null where they do not apply; and `decoded`.
  virtual nlohmann::ordered_json subject_json(std::span<const std::uint8_t> request) const = 0;
  virtual nlohmann::ordered_json decoded_json(const serial::Answer& answer) const = 0;
};

/// An action of the master.
struct MasterAction {
  enum class Kind : std::uint8_t {
    Request,
    Raw,      ///< a frame as it was written
    Station,  ///< from here on to this one
    Wait,
  };

  Kind kind = Kind::Request;
  std::string text;                            ///< as it was written: `read 40011:2`
  std::uint8_t station = 1;                    ///< that is asked; of Raw, the first byte
  std::shared_ptr<ProtocolRequest> request{};  ///< of Request and Raw
  Time duration = 0;                           ///< of Wait
};

/// An option that only some protocols have.
struct ProtocolOption {
  std::string_view name;                                   ///< `--end-character`
  std::string_view value;                                  ///< its value in the help: `FORM`; empty for a flag
  std::string meaning;                                     ///< for the help
  std::string standard{};                                  ///< value without the option
  std::function<std::string(const std::string&)> check{};  ///< what is wrong with a value; nothing if it is right
};

/// The user's choices for a protocol.
struct ProtocolUse {
  std::uint8_t station = 1;                                 ///< until an action changes it
  bool over_modbus_tcp = false;                             ///< stations are units
  std::map<std::string, std::string, std::less<>> given{};  ///< its options by name; flags with any value
  bool of_another_make = false;                             ///< the PLCs asked are, and have stations as their maker says
  bool options_are_open = true;                             ///< so that a message may name one that helps

  bool has(std::string_view option) const { return given.contains(option); }

  /// The place among its words of what is given for an option; 0 if nothing is.
  std::size_t chosen(std::string_view option, std::span<const std::string_view> words) const;
};

/// How long a master waits for answers, and what it does before it asks again, unless options say otherwise.
struct Patience {
  Time timeout = kSecond;
  int retries = 0;
  Time pause = 0;  ///< before it asks again
  /// The frame to send before all others, whatever is answered; null: there is none.
  serial::Frame (*first)(const ProtocolUse& use) = nullptr;
  std::string_view without_first{};                ///< the option that leaves that out
  bool (*repeats)(std::uint16_t error) = nullptr;  ///< a refusal that it asks again after; null: none
};

struct Protocol {
  std::string_view name, meaning;       ///< on the command line, and in its help
  std::optional<std::uint8_t> station;  ///< that is asked if none is named; nothing: its messages have none
  SerialFormat format;                  ///< of a device, as far as options leave it open
  bool over_modbus_tcp;                 ///< it can be spoken there
  std::vector<ProtocolOption> options;
  std::string actions_help;               ///< a table for people
  std::vector<std::string> action_words;  ///< what each of them begins with

  /// Parses actions. Throws std::invalid_argument for the first word that cannot be done, so that nothing is sent if any of
  /// them is wrong.
  std::vector<MasterAction> (*actions)(const std::vector<std::string>& words, const ProtocolUse& use);

  /// Whether characters are a complete answer: nothing more has to be waited for.
  bool (*is_complete)(std::span<const std::uint8_t> response);

  /// A warning about actions that probably mean something else; empty if all is well. Null: never.
  std::string (*doubt)(const std::vector<MasterAction>& actions, const ProtocolUse& use) = nullptr;

  Patience patience{};

  std::string_view choices{};  ///< options for what its document leaves open, with their marks: `[L10] --timeout, --retries`

  std::string_view refusal = "error";  ///< what a refusal is called

  bool wants_freeport = true;  ///< of a program: its port is to be in Freeport mode; otherwise it is to speak PPI

  /// PLCs of another make that speak it, in simulation; null: none.
  const westinghouse::PlcRow* plcs = nullptr;
};

/// All protocols; the first is spoken if the user names none.
std::span<const Protocol* const> protocols();

/// The keys of ProtocolRequest::subject_json(), all null: what a request does not have stays so.
nlohmann::ordered_json empty_subject();

/// Returns null if no protocol has this name.
const Protocol* find_protocol(std::string_view name);

/// The frames of the actions that are raw ones, as they were written.
std::vector<std::string> raw_frames(const std::vector<MasterAction>& actions);

/// All protocols with their actions, for the help.
std::string protocols_help();

/// The settings of simulated PLCs of another make, by protocol and model.
std::string simulated_plcs_help();

const Protocol& modbus_protocol();
const Protocol& freeport_pc_protocol();
const Protocol& pc1000_lan_protocol();
const Protocol& westnet_protocol();
const Protocol& pc500_loader_protocol();
const Protocol& hppc_protocol();
const Protocol& ppi_protocol();

}  // namespace s7200::tools
