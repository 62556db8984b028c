// The CPU of a program where neither an option nor a key names one.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/base/file_source.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::tools {

/// The file with the CPU of the programs in its folder, one key: `cpu: 224`.
inline constexpr std::string_view kFolderSettings = "s7200.yaml";

struct ProgramCpu {
  const CpuModel* model = nullptr;  ///< null if the folder's settings are wrong
  std::string note{};               ///< what the user has to be told; empty if it is what he expects
  std::string why{};                ///< what is wrong with the settings
};

/// The CPU in the head of the program, else in `s7200.yaml` in the folder of the file `path`, else the first CPU that can
/// run the program.
ProgramCpu cpu_of_program(const SourceText& text, const std::string& path, const FileSource& files);

}  // namespace s7200::tools
