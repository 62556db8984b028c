// --report, of the verbs that run something.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/command/reports/report_page.hpp"
#include "tools/host/files/written_files.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class ReportOption {
 public:
  /// `text`: what the help says is in it.
  void add_to(CLI::App& app, const std::string& text);

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }

  /// Reads the page that reports are made of, and claims the place, before anything is run. False after a message. Of an
  /// option that was not given there is nothing to do, here and below.
  bool prepare();

  /// The same for a verb that runs a plan: some S7-200 must be in it.
  bool prepare_for(const SystemPlan& plan);

  /// False after a message.
  bool write(std::string_view verb, const std::vector<ReportedRun>& runs) const;

  /// The same of what `decode --json` prints.
  bool write_conversation(const nlohmann::ordered_json& decoded) const;

 private:
  bool write_page(const std::function<std::string()>& page) const;

  std::string path_;
  std::string page_;
  std::optional<Destination> to_;
};

}  // namespace s7200::tools
