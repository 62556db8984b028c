#include "tools/command/options/verb/report_option.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/wanted_file.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/files/own_folder.hpp"

namespace s7200::tools {
namespace {

namespace fs = std::filesystem;

/// Every report begins so, as tools/faces/page/build writes it.
constexpr std::string_view kBeginning = "<!DOCTYPE html>\n<!-- s7200: the page with its engine -->\n";

/// The page: beside the folder of the command where it is installed or built, beside the command itself in a folder that is
/// carried about.
fs::path page_file(const fs::path& own_folder) {
  std::error_code gone;
  const fs::path beside = own_folder / "page.html";
  return fs::exists(beside, gone) ? beside : own_folder.parent_path() / "share/s7200/page.html";
}

/// What makes the page where there is none: of a build tree its target.
std::string how_to_make_the_page(const fs::path& above) {
  std::error_code gone;
  if (!fs::exists(above / "CMakeCache.txt", gone)) return "the package of s7200 has it; install it with the command";
  return fmt::format("make it with: cmake --build {} --target page_file", above.string());
}

}  // namespace

void ReportOption::add_to(CLI::App& app, const std::string& text) {
  app.add_option("--report", path_, text)->type_name("FILE.html")->group(help_group::kResults);
}

bool ReportOption::prepare() {
  if (!wanted()) return true;
  const fs::path folder = file_path(own_folder());
  const std::string path = page_file(folder).string();
  const auto page = read_file(path);
  if (!page)
    return print_error(fmt::format("--report needs the page with its engine, and cannot read {}: {}; {}", path, page.why(),
                                   how_to_make_the_page(folder.parent_path()))),
           false;
  page_ = *page;
  WrittenFiles files;
  auto claimed = files.claim("--report", path_, {"a report of s7200", std::string(kBeginning)}, Replace::Own);
  if (!claimed) print_error(claimed.why());
  to_ = std::move(claimed).if_any();
  return to_.has_value();
}

bool ReportOption::prepare_for(const SystemPlan& plan) {
  if (!wanted() || !plan.plcs.empty()) return prepare();
  print_error("--report shows programs at work, and there is no S7-200 in this system");
  return false;
}

bool ReportOption::write(std::string_view verb, const std::vector<ReportedRun>& runs) const {
  if (!wanted()) return true;
  for (const ReportedRun& run : runs)
    for (const Recording& recording : run.recordings)
      if (!recording.complete)
        return print_error(fmt::format("cannot write {}: the beginning of the run is forgotten, so it cannot be run again",
                                       stl::printable(path_))),
               false;
  return write_page([&] { return with_runs(page_, verb, runs); });
}

bool ReportOption::write_conversation(const nlohmann::ordered_json& decoded) const {
  return !wanted() || write_page([&] { return with_conversation(page_, decoded); });
}

bool ReportOption::write_page(const std::function<std::string()>& page) const {
  try {
    return write_wanted(to_, page());
  } catch (const std::runtime_error& error) {
    print_error(fmt::format("cannot write {}: {}", stl::printable(path_), error.what()));
    return false;
  }
}

}  // namespace s7200::tools
