// The data block of a project: V memory as the download leaves it.
//
// Bytes, words and double words follow each other from the address of their line on; a line without an address goes on in
// the size of the line before it. Text takes a byte for each character, a string in double quotes has its length before it.
//
// Not documented, modelled so: a byte that two lines set is an error, as it cannot be meant. [DataBlock.AByteIsSetOnce]
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// Places the data block of `source` in the memory of `model`, in order of address; adds what is wrong to `diagnostics`.
std::vector<InitialData> place_data(const stl::Source& source, const CpuModel& model, stl::Diagnostics& diagnostics);

}  // namespace s7200
