// The files of this computer, for the commands of a session.
#pragma once

#include <utility>

#include "tools/host/files/written_files.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/commands/session_files.hpp"

namespace s7200::tools {

class HostFiles final : public SessionFiles {
 public:
  /// `taken`: those that are read and written already.
  explicit HostFiles(WrittenFiles taken = WrittenFiles()) : taken_(std::move(taken)) {}

  std::optional<std::string> read(const std::string& path, std::string& why) const override;
  bool begins(const std::string& path, std::string_view beginning) const override;
  std::optional<FilePlace> place_for(const WantedFile& wanted, std::string& why) const override;
  std::vector<std::string> names(std::string_view beginning) const override;
  std::string saved(const SessionFile& session) const override { return to_text(session); }
  std::optional<SessionFile> loaded(std::string_view text, std::span<const CpuModel* const> models,
                                    std::span<const std::string> stations, std::string& why) const override {
    return session_from_text(text, models, stations, why);
  }

 private:
  WrittenFiles taken_;
};

}  // namespace s7200::tools
