// The files of this computer, for the commands of a session.
#pragma once

#include <utility>

#include "interpreter/base/result.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/commands/session_files.hpp"

namespace s7200::tools {

class HostFiles final : public SessionFiles {
 public:
  /// `taken`: those that are read and written already.
  explicit HostFiles(WrittenFiles taken = WrittenFiles()) : taken_(std::move(taken)) {}

  Result<std::string> read(const std::string& path) const override;
  bool begins(const std::string& path, std::string_view beginning) const override;
  Result<FilePlace> place_for(const WantedFile& wanted) const override;
  std::vector<std::string> names(std::string_view beginning) const override;
  std::string saved(const SessionFile& session) const override { return to_text(session); }
  Result<SessionFile> loaded(std::string_view text, std::span<const CpuModel* const> models,
                             std::span<const std::string> stations) const override {
    return session_from_text(text, models, stations);
  }

 private:
  WrittenFiles taken_;
};

}  // namespace s7200::tools
