// What `s7200 master` is asked to do: words to requests.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/time.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/views/register_text.hpp"

namespace s7200::tools {

struct MasterAction {
  enum class Kind : std::uint8_t {
    Request,   ///< `pdu` to the station
    Loopback,  ///< function 8 with a word that is another each time
    Raw,       ///< `frame` as it is
    Station,   ///< from here on to this one
    Wait,
  };

  Kind kind = Kind::Request;
  std::string text;  ///< as it was written: `read 40011:2`
  Bytes pdu{};
  serial::Frame frame{};
  std::uint8_t station = 1;  ///< that is asked; of Raw, the first byte
  Time duration = 0;         ///< of Wait

  /// What reads and writes of data are about.
  std::optional<modbus::DataAddress> first{};
  std::uint16_t count = 0;

  /// A broadcast, or a subfunction that is never answered.
  bool answer_expected = true;
};

struct ActionRules {
  std::uint8_t station = 1;  ///< until an action changes it
  std::uint8_t last_station = modbus::kLastStation;
  bool crc = false;            ///< raw frames get one
  bool always_15 = false;      ///< for single coils too
  bool always_16 = false;      ///< for single registers too
  bool beyond_limits = false;  ///< of the specification; of frames there is a limit all the same: kLongestRawFrame
  ValueFormat format{};        ///< of values to be written
};

/// Throws std::invalid_argument for the first that cannot be done, so that nothing is sent if any of them is wrong: unknown
/// words, addresses and values, writes to inputs, broadcast reads, what exceeds the specification.
std::vector<MasterAction> parse_actions(const std::vector<std::string>& words, const ActionRules& rules);

/// The frames of the actions that are raw ones, as they were written.
std::vector<std::string> raw_frames(const std::vector<MasterAction>& actions);

/// The words in a table for people, with the functions they lead to.
std::string actions_help();

/// `holding registers 10…11`, `coil 3`
std::string range_text(const modbus::DataAddress& first, std::uint16_t count);

}  // namespace s7200::tools
