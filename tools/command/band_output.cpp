#include "tools/command/band_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interpreter/base/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/measuring/parallel_run.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// `shortest with cpu214, longest with random table 12 of seed 1`, if they differ; with which table what came of the
/// exchange was first another than with most; and with which the CPU stopped first.
std::string tables_text(const ExchangeBand& band, const ProgramBand& tables) {
  std::string text;
  if (band.latency().any() && band.latency().least != band.latency().most)
    text += fmt::format("  shortest with {}, longest with {}\n", tables.table_name(band.shortest()),
                        tables.table_name(band.longest()));
  const auto add = [&](const ExchangeBand::Count& count) {
    text += fmt::format("  {} with {}\n", count.what, tables.table_name(count.first));
  };
  const auto usual = std::ranges::max_element(band.verdicts(), {}, &ExchangeBand::Count::tables);
  for (const ExchangeBand::Count& count : band.verdicts())
    if (&count != &*usual) add(count);
  std::ranges::for_each(band.stops(), add);
  return text;
}

void print_bands(const BandExchanges& exchanges, const std::string& title, const std::vector<ExchangeBand>& bands,
                 const ProgramBand& tables) {
  fmt::print("{}\n", title);
  for (std::size_t i = 0; i < bands.size(); ++i)
    fmt::print("{}\n  {}\n{}", stl::printable(exchanges.labels[i].text), bands[i].text(),
               stl::printable_lines(tables_text(bands[i], tables)));
}

void print_json(const BandExchanges& exchanges, const std::string& title, const std::vector<ExchangeBand>& bands,
                const ProgramBand& tables) {
  auto results = results_of(exchanges.verb);
  results["band"] = {{"times", title}, {"exchanges", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < bands.size(); ++i) {
    nlohmann::ordered_json exchange{{exchanges.key, exchanges.labels[i].value}};
    exchange.update(bands[i].json());
    const bool any = bands[i].latency().any();
    const auto name = [&](std::size_t table) { return any ? nlohmann::ordered_json(tables.table_name(table)) : nullptr; };
    exchange["shortest_with"] = name(bands[i].shortest());
    exchange["longest_with"] = name(bands[i].longest());
    const auto name_first = [&](const char* list, const ExchangeBand::Counts& counts) {
      for (std::size_t j = 0; j < counts.size(); ++j) exchange[list][j]["first_with"] = tables.table_name(counts[j].first);
    };
    name_first("verdicts", bands[i].verdicts());
    name_first("stops", bands[i].stops());
    results["band"]["exchanges"].push_back(std::move(exchange));
  }
  fmt::print("{}", lines_of(results));
}

}  // namespace

int run_band(const BandOptions& band, const ProgramOptions& program, RigOptions& rig_options, bool json,
             const BandExchanges& exchanges) {
  rig_options.refuse_what_is_of_one_run("--times-band makes many");
  int exit_code = kFine;
  const auto programs = band.load(program, exit_code);
  if (!programs) return exit_code;
  if (!rig_options.assemble(programs->program(0), json)) return rig_options.exit_code_without_rig();
  const auto with_table = [&](std::size_t table) {
    const auto of_table = programs->program(table);
    std::vector<std::string> problems;
    const auto rig = rig_options.assemble_another(of_table, problems);
    if (!rig) throw std::runtime_error(problems.empty() ? "interrupted" : problems.front());
    LostEvents lost;
    rig->sinks().add(&lost);
    rig->power_up();
    auto outcomes = exchanges.run(*rig, of_table->source.name, lost);
    outcomes.resize(exchanges.labels.size(), {.verdict = "not sent", .stop = stop_text(rig->cpu())});
    return outcomes;
  };
  std::vector<ExchangeBand> bands(exchanges.labels.size());
  BandProgress progress(programs->size());
  ParallelRun<std::vector<BandOutcome>> run(programs->size(), band.jobs(), with_table);
  run.each(
      [&](std::size_t, const std::vector<BandOutcome>& found) {
        if (interrupted()) return false;
        for (std::size_t i = 0; i < bands.size(); ++i) bands[i].add(found[i]);
        return true;
      },
      std::ref(progress));
  progress.clear();
  std::string title = band_title(program, band.settings());
  const std::size_t done = bands.empty() ? 0 : bands.front().tables();
  if (done < programs->size()) title += fmt::format("; {} of these {} tables", done, programs->size());
  (json ? print_json : print_bands)(exchanges, title, bands, *programs);
  print_interruption();
  const bool always =
      std::ranges::all_of(bands, [&](const ExchangeBand& each) { return each.count(exchanges.good) == programs->size(); });
  return always ? kFine : kCheckFailed;
}

}  // namespace s7200::tools
