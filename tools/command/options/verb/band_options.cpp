#include "tools/command/options/verb/band_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <thread>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/console.hpp"
#include "tools/host/host_time.hpp"

namespace s7200::tools {

unsigned BandOptions::every_core() { return std::max(1U, std::thread::hardware_concurrency()); }

void BandOptions::add_tables_to(CLI::App& app) {
  add_whole_number(app, "--times-band", settings_.random, {1, 100'000},
                   "show how far results depend on the times: run with every named table and N random ones");
  add_whole_number(app, "--band-seed", settings_.seed, {0, UINT32_MAX}, "seed of the random tables", "1");
}

void BandOptions::add_to(CLI::App& app) {
  add_tables_to(app);
  auto* band = app.get_option("--times-band");
  app.get_option("--band-seed")->needs(band);
  add_whole_number(app, "--jobs", jobs_, {1, 64}, "tables at a time; the output is the same", "every core")->needs(band);
  app.add_option("--tip41", tip41_,
                 "the document of Application Tip 41: count apart the tables with which it does what it says of itself")
      ->type_name("FILE")
      ->needs(band);
}

std::unique_ptr<ProgramBand> BandOptions::load(const ProgramOptions& program, int& exit_code) const {
  exit_code = kUnusable;
  auto text = program.cpu.empty() || program.model() ? read_project(program.path, program.parts) : std::nullopt;
  const CpuModel* model = text ? program.model_for(*text, program.path) : nullptr;
  auto tables = model ? program.band(*model, settings_) : std::nullopt;
  const auto checked = tables ? program.load(*text, *model, (*tables)[0], exit_code) : nullptr;
  if (!checked) return nullptr;
  std::vector<std::string> unknown;
  repair(text->parsed.source, program.repairs, unknown);
  return std::make_unique<ProgramBand>(std::move(text->parsed), *model, std::move(*tables), checked->system_block);
}

std::string band_title(const CpuModel& model, const std::string& times_table, const BandSettings& settings) {
  const auto names = names_in_band(model, times_table);
  return fmt::format("execution times: {}, and {} around {} (seed {})", stl::printable(stl::joined(names, std::identity{})),
                     counted(settings.random, "random table"), names.size() == 1 ? "it" : "them", settings.seed);
}

BandProgress::BandProgress(std::size_t all)
    : all_(all), from_(host_time() + 2 * kSecond), wanted_(is_terminal(Standard::Error)) {}

void BandProgress::operator()(std::size_t done) {
  if (!wanted_ || host_time() < from_) return;
  fmt::print(stderr, "\r{} of {} tables", done, all_);
  std::fflush(stderr);
  shown_ = true;
}

void BandProgress::clear() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
  shown_ = false;
}

}  // namespace s7200::tools
