#include "tools/command/debugging/view_scenario.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

int view_scenario(const CLI::App& verb, const WantedScenario& wanted, bool files, page::PageServer server,
                  page::PageFlags& flags) {
  const std::string option = option_of_a_program(verb, {"--only", "--target", "--listen", "--token-file", "--files"});
  if (!option.empty())
    return print_error(fmt::format("{} is about a program; a scenario says that itself, in its head", option)), kUnusable;
  int exit_code = kFine;
  catch_interruption();
  const auto one = OpenedScenario::open(wanted, exit_code);
  if (!one) return exit_code;
  const auto plant = one->plant();
  const HostFiles host_files;
  History history(plant->stations(), plant->history_settings());
  if (!history.replay(one->recording()))
    return print_error("the scenario does not run the same way here; 'test' shows what it found"), kUnusable;
  history.go_to(one->place().moment);
  SessionSetup setup = one->setup();
  if (files) setup.files = &host_files;
  setup.why_no_files = kWhyNoFiles;
  fmt::print(stderr, "{}", one->heading());
  page::serve(std::move(server), history,
              {.session = std::move(setup),
               .program = one->name(),
               .failed = one->failed_memory(),
               .found = one->has_failed() ? one->heading() : ""},
              flags, [](auto) {});
  return kFine;
}

}  // namespace s7200::tools
