#include "tools/command/running/band_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/timing/statements_output.hpp"
#include "tools/host/interruption.hpp"
#include "tools/measuring/parallel_run.hpp"
#include "tools/measuring/statements.hpp"
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

/// What came of an exchange with all tables, and with those that agree with all that is known of real CPUs.
struct OneExchange {
  ExchangeBand all, agreeing;
};

struct Results {
  std::string title;
  std::vector<OneExchange> exchanges;
  bool judged;  ///< it was looked which tables agree
};

std::string agreeing_text(const ExchangeBand& agreeing) {
  if (agreeing.tables() == 0) return "  none of the tables agrees with what is known\n";
  return fmt::format("  with those that agree with what is known: {}\n", agreeing.text());
}

void print_text(const BandExchanges& exchanges, const Results& results, const ProgramBand& tables) {
  fmt::print("{}\n", results.title);
  for (std::size_t i = 0; i < results.exchanges.size(); ++i) {
    const auto& [all, agreeing] = results.exchanges[i];
    fmt::print("{}\n  {}\n{}{}", stl::printable(exchanges.labels[i].text), all.text(),
               results.judged ? agreeing_text(agreeing) : "", stl::printable_lines(tables_text(all, tables)));
  }
}

void name_first(nlohmann::ordered_json& list, const ExchangeBand::Counts& counts, const ProgramBand& tables) {
  for (std::size_t i = 0; i < counts.size(); ++i) list[i]["first_with"] = tables.table_name(counts[i].first);
}

nlohmann::ordered_json exchange_json(const OneExchange& exchange, bool judged, const ProgramBand& tables) {
  const auto& [all, agreeing] = exchange;
  nlohmann::ordered_json json = all.json();
  const bool any = all.latency().any();
  const auto name = [&](std::size_t table) { return any ? nlohmann::ordered_json(tables.table_name(table)) : nullptr; };
  json["shortest_with"] = name(all.shortest());
  json["longest_with"] = name(all.longest());
  name_first(json["verdicts"], all.verdicts(), tables);
  name_first(json["stops"], all.stops(), tables);
  json["agreeing"] = judged ? nlohmann::ordered_json(agreeing.tables()) : nullptr;
  for (auto& verdict : json["verdicts"])
    verdict["agreeing"] = judged ? nlohmann::ordered_json(agreeing.count(verdict["verdict"].get<std::string>())) : nullptr;
  if (!any) return json;
  const auto of_agreeing = to_json(agreeing.latency());
  for (const char* const end : {"least", "most"})
    json["latency_us"][fmt::format("{}_agreeing", end)] = of_agreeing.is_null() ? of_agreeing : of_agreeing[end];
  return json;
}

void print_json(const BandExchanges& exchanges, const Results& results, const ProgramBand& tables) {
  auto json = results_of(exchanges.verb);
  json["band"] = {{"times", results.title}, {"exchanges", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < results.exchanges.size(); ++i) {
    nlohmann::ordered_json exchange{{exchanges.key, exchanges.labels[i].value}};
    exchange.update(exchange_json(results.exchanges[i], results.judged, tables));
    json["band"]["exchanges"].push_back(std::move(exchange));
  }
  fmt::print("{}", lines_of(json));
}

bool agrees(const CpuModel& model, const TimeTable& times, const SourceText& tip41) {
  return std::ranges::count(check_statements(model, times, &tip41), Statement::Verdict::Fails, &Statement::verdict) == 0;
}

/// With one table.
struct Turn {
  std::vector<BandOutcome> outcomes;
  bool agrees;
};

}  // namespace

int run_band(const BandOptions& band, const ProgramOptions& program, RigOptions& rig_options, ReportOption& report,
             bool json, const BandExchanges& exchanges) {
  rig_options.refuse_what_is_of_one_run("--times-band makes many");
  int exit_code = kFine;
  const auto programs = band.load(program, exit_code);
  if (!programs) return exit_code;
  const auto tip41 = band.tip41().empty() ? std::nullopt : read_tip41(band.tip41());
  if (!tip41 && !band.tip41().empty()) return kUnusable;
  if (!rig_options.take(programs->program(0)) || !rig_options.assemble(json)) return rig_options.exit_code_without_rig();
  if (!report.prepare()) return kUnusable;
  bool report_written = true;
  const auto with_table = [&](std::size_t table, bool reported) {
    const auto checked = programs->program(table);
    const auto of_table = program.every_scan ? with_every_scan(*checked) : checked;
    std::vector<std::string> problems;
    const auto rig = rig_options.assemble_another(of_table, problems);
    if (!rig) throw std::runtime_error(problems.empty() ? "interrupted" : problems.front());
    LostEvents lost;
    rig->sinks().add(&lost);
    rig->power_up();
    const auto recorder = reported ? std::make_unique<RunRecorder>(*rig, "", rig_options.spot()) : nullptr;
    auto outcomes = exchanges.run(*rig, of_table->source.name, lost, recorder.get());
    if (recorder) report_written = recorder->write(report, exchanges.verb, program.repairs);
    outcomes.resize(exchanges.labels.size(), {.verdict = "not sent", .stop = stop_text(rig->cpu())});
    return Turn{std::move(outcomes), tip41 && agrees(programs->model(), programs->times(table), *tip41)};
  };
  Results results{band_title(programs->model(), program.times_table, band.settings()),
                  std::vector<OneExchange>(exchanges.labels.size()), tip41.has_value()};
  BandProgress progress(programs->size());
  ParallelRun<Turn> run(programs->size(), band.jobs(), [&](std::size_t table) { return with_table(table, false); });
  std::optional<std::size_t> first_bad;
  run.each(
      [&](std::size_t table, const Turn& turn) {
        if (interrupted()) return false;
        const bool good = std::ranges::all_of(turn.outcomes,
                                              [&](const BandOutcome& outcome) { return outcome.verdict == exchanges.good; });
        if (!good && !first_bad) first_bad = table;
        for (std::size_t i = 0; i < turn.outcomes.size(); ++i) {
          results.exchanges[i].all.add(turn.outcomes[i]);
          if (turn.agrees) results.exchanges[i].agreeing.add(turn.outcomes[i]);
        }
        return true;
      },
      std::ref(progress));
  progress.clear();
  const std::size_t done = results.exchanges.empty() ? 0 : results.exchanges.front().all.tables();
  if (done < programs->size()) results.title += fmt::format("; {} of these {} tables", done, programs->size());
  (json ? print_json : print_text)(exchanges, results, *programs);
  if (report.wanted() && !interrupted()) {
    with_table(first_bad.value_or(0), true);
    print_note(fmt::format("the report shows the run with {}", programs->table_name(first_bad.value_or(0))));
  }
  print_interruption();
  if (!report_written) return kUnusable;
  const bool always = std::ranges::all_of(results.exchanges, [&](const OneExchange& exchange) {
    return exchange.all.count(exchanges.good) == programs->size();
  });
  return always ? kFine : kCheckFailed;
}

}  // namespace s7200::tools
