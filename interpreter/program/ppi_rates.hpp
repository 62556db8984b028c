// Rates of ports in PPI mode. On a CPU they are part of the system block, which is downloaded with the program.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200 {

struct Program;

/// In baud, by port.
using PpiRates = std::array<std::uint32_t, kPorts.size()>;

/// As a CPU is delivered.
inline constexpr PpiRates kUsualPpiRates{9600, 9600};

/// `19200` for each port of the CPU; `9600,187500` for port 0 and port 1. The rates are 9600, 19200 and, on CPU 22x, 187500
/// (facts 10.9). Returns nothing and sets `why` for anything else.
std::optional<PpiRates> parse_ppi_rates(std::string_view text, const CpuModel& model, std::string& why);

/// As parse_ppi_rates() takes them: one for both ports if they are the same.
std::string to_text(const PpiRates& rates);

/// The same program with other rates.
std::shared_ptr<const Program> with_ppi_rates(const Program& program, const PpiRates& rates);

}  // namespace s7200
