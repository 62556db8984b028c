// What calibrate has found, for machines, and what it says about it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "interpreter/model/cpu_model.hpp"
#include "tools/calibration/fit.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {

nlohmann::ordered_json to_json(const CpuModel& model, const Measurement& measurement, const Fit& fit);

/// Where and when figures were measured: for the table.
std::string source_of(const CpuModel& model, const Measurement& measurement, const Fit& fit, const std::string& firmware);

/// What the table has of figures that were not measured.
std::string not_measured_text(const Fit& fit, const CpuModel& model);

/// Throws WrongCpu if SMB6 is that of other CPUs.
void refuse_another_cpu(const CpuModel& model, std::uint8_t identification);

/// Why SMB6 leaves a doubt about the CPU; empty if there is none. `known`: the user says which it is.
std::string doubt_about_cpu(const CpuModel& model, std::uint8_t identification, bool known);

/// Empty if all of so many loops were measured.
std::string interruption_note(const Measurement& measurement, std::size_t loops);

/// Empty if the loops agree.
std::string contradiction_note(const Fit& fit);

}  // namespace s7200::tools
