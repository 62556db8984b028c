// The parts of a project's system block that are modelled: ports in PPI mode, and what survives power off. It is downloaded
// with the program.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200 {

struct Program;

/// The rates in baud, by port.
using PpiRates = std::array<std::uint32_t, kPorts.size()>;

/// Addresses on the network, by port.
using PpiStations = std::array<std::uint8_t, kPorts.size()>;

/// The fate of a request whose master has not fetched the answer to the one before (cpu/ports/ppi.hpp). No system block says
/// it; it is chosen here, where ports are set.
enum class SecondRequest : std::uint8_t {
  Replaces,  ///< it takes the place of the one before
  Refused    ///< there is no resource, as for another master
};
inline constexpr std::array<std::string_view, 2> kSecondRequestWords{"replaces", "refused"};

/// The settings of a CPU as it is delivered, if nothing else is said (facts 10.9).
struct SystemBlock {
  PpiRates ppi_rates{9600, 9600};
  PpiStations ppi_stations{2, 2};
  SecondRequest second_request = SecondRequest::Replaces;
  std::optional<std::vector<RetentiveRange>> retentive{};  ///< nothing: those of the CPU
  auto operator<=>(const SystemBlock&) const = default;
};

/// The rates that there are (facts 10.9): `9600, 19200 or, on CPU 22x, 187500`.
std::string ppi_rates_text();

/// `19200` for each port of the CPU; `9600,187500` for port 0 and port 1. Trouble for anything else.
Result<PpiRates> parse_ppi_rates(std::string_view text, const CpuModel& model);

/// The same of stations, 1 to 126: `3`; `3,4` for port 0 and port 1.
Result<PpiStations> parse_ppi_stations(std::string_view text, const CpuModel& model);

/// One of kSecondRequestWords. Trouble for anything else.
Result<SecondRequest> parse_second_request(std::string_view text);

/// The most ranges of memory that a system block makes retentive.
inline constexpr std::size_t kMostRetentiveRanges = 6;

/// The memory that a system block of this CPU can make retentive: V, M, the timers of TONR, and the counters.
std::vector<RetentiveRange> retainable(const CpuModel& model);

/// `VB0:100,MB0:14,T0:32,C5`: up to six ranges of V, M, T or C, or `none`. Trouble for anything else.
Result<std::vector<RetentiveRange>> parse_retentive(std::string_view text, const CpuModel& model);

/// The ranges as they are parsed.
std::string to_text(const std::vector<RetentiveRange>& ranges);

/// The rates as they are parsed: one for both ports if they are the same.
std::string to_text(const PpiRates& rates);
std::string to_text(const PpiStations& stations);
inline std::string_view to_text(SecondRequest request) { return kSecondRequestWords[static_cast<std::size_t>(request)]; }

/// The same program with another system block.
std::shared_ptr<const Program> with_system_block(const Program& program, const SystemBlock& block);

}  // namespace s7200
