#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <sstream>

#include "serial_sim/modbus/crc.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/line_options.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/options/rig_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/text_frame.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {
namespace {

struct SendOptions {
  ProgramOptions program;
  std::vector<std::string> frames, texts;
  std::vector<bool> text_is_next;  // of frames and texts, in the order of the command line
  std::string frames_file;
  bool crc = false, json = false, timeline = false;
  Time after = kNever;  // kNever: when the first scan has ended and the line is quiet
  Time pause = kNever;  // kNever: Simulation::default_quiet
  serial::MasterSettings master;
  RigOptions rig;
};

/// A line of a file of frames, without its end.
std::string without_comment(const std::string& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t quotation = quotation_length(std::string_view(line).substr(begin));
  if (quotation == std::string_view::npos) return line;
  return line.substr(0, std::min(line.find('#', begin + quotation), line.find('\r', begin + quotation)));
}

/// All frames of the command line and the file; a message and false when one is no frame.
bool read_frames(const SendOptions& options, std::vector<serial::Frame>& frames) {
  struct Written {
    std::string text, place;
    serial::ParsedFrame (*parse)(std::string_view);
  };
  std::vector<Written> written;
  auto frame = options.frames.begin(), text = options.texts.begin();
  for (const bool is_text : options.text_is_next) {
    const std::string& next = is_text ? *text++ : *frame++;
    written.push_back(
        {next, fmt::format("{} '{}'", is_text ? "--text" : "frame", next), is_text ? parse_text : serial::parse_hex_frame});
  }
  if (!options.frames_file.empty()) {
    std::string why;
    const auto bytes = read_file(options.frames_file, why);
    if (!bytes) {
      print_error(fmt::format("cannot read {}: {}", options.frames_file, why));
      return false;
    }
    std::istringstream lines(*bytes);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      line = without_comment(line);
      if (line.find_first_not_of(" \t") != std::string::npos)
        written.push_back({line, fmt::format("{}:{}", options.frames_file, number), parse_hex_or_quoted});
    }
  }
  if (written.empty()) {
    print_error("no frame to send: give frames in hex, --text, or --frames FILE");
    return false;
  }
  for (const Written& w : written) {
    serial::ParsedFrame parsed = w.parse(w.text);
    if (!parsed.ok()) {
      print_error(fmt::format("{}: column {}: {}", w.place, parsed.errors[0].column, parsed.errors[0].message));
      return false;
    }
    if (options.crc) modbus::append_crc(parsed.frame);
    frames.push_back(std::move(parsed.frame));
  }
  return true;
}

nlohmann::ordered_json to_json(const serial::Exchange& exchange, const Bytes& unasked) {
  nlohmann::ordered_json json{
      {"request", plain_hex(serial::bytes_of(exchange.request))}, {"response", nullptr}, {"latency_us", nullptr}};
  if (!unasked.empty()) json["unasked"] = plain_hex(unasked);
  if (const auto text = plain_text({}, unasked)) json["unasked_text"] = *text;
  if (!exchange.echo.empty()) json["echo"] = plain_hex(serial::bytes_of(exchange.echo));
  const Bytes request = serial::bytes_of(exchange.request);
  if (const auto text = plain_text(request, request)) json["request_text"] = *text;
  if (exchange.timed_out) return json;
  if (const auto text = plain_text(request, exchange.response_bytes())) json["response_text"] = *text;
  json["response"] = plain_hex(exchange.response_bytes());
  json["latency_us"] = static_cast<double>(*exchange.latency()) / kMicrosecond;
  if (exchange.parity_error()) json["parity_error"] = true;
  if (exchange.framing_error()) json["framing_error"] = true;
  return json;
}

int run_send(SendOptions& options) {
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  std::vector<serial::Frame> frames;
  if (!read_frames(options, frames)) return kUnusable;
  const auto rig = options.rig.assemble(program, options.json);
  if (!rig) return kUnusable;
  serial::Simulation& simulation = rig->simulation();
  rig->power_up();
  TraceSink* const records = rig->sinks().empty() ? nullptr : &rig->sinks();
  Timeline timeline(program, records);

  auto results = results_of("send");
  nlohmann::ordered_json& exchanges = results["exchanges"] = nlohmann::ordered_json::array();
  SimulatedSlave slave(simulation, options.master, program->source.name);
  std::string why;
  const bool ready = slave.wait_until_ready(options.after, why);
  if (ready) print_note_if_any(slave.note_on_port());
  if (!why.empty()) print_error(why);
  std::size_t answered = 0;
  for (const serial::Frame& frame : frames) {
    if (!ready || interrupted() || options.rig.failed_strictly(simulation.cpu())) break;
    const serial::Faults::State faults_before = simulation.faults().state();
    timeline.begin();
    if (options.timeline) simulation.cpu().set_sink(&timeline);
    const Bytes unasked = serial::bytes_of(simulation.master().heard());
    const serial::Exchange exchange = slave.exchange(options.master.request(frame));
    simulation.cpu().set_sink(records);
    if (simulation.master().busy()) break;  // Ctrl-C came before the answer
    answered += !exchange.timed_out;
    if (options.json) {
      exchanges.push_back(to_json(exchange, unasked));
      if (options.rig.faulted()) exchanges.back()["faults"] = faults_json(simulation.faults(), faults_before);
      if (options.timeline) exchanges.back()["timeline"] = to_json(timeline.report(), exchange);
    } else {
      fmt::print("{}{}", unasked_text(unasked), exchange_text(exchange, options.master.timeout));
      if (options.timeline) fmt::print("{}\n", to_text(timeline.report(), exchange, colour_wanted(stdout)));
    }
    slave.wait(options.pause == kNever ? slave.pause() : options.pause);
  }
  const bool all_written = finish(*rig);
  if (options.json) {
    results.update(options.rig.json(simulation));
    fmt::print("{}", lines_of(results));
  } else {
    fmt::print("{}", options.rig.dump_text(simulation.cpu()));
  }
  fmt::print(stderr, "{}", errors_text(simulation.cpu()));
  print_notes(fault_notes(simulation.faults()));
  if (ready && answered == 0) print_note_if_any(torn_frame_note(options.frames));
  if (simulation.cpu().state().mode == Mode::Stop) print_note("the CPU is in STOP");
  if (!all_written) return kUnusable;
  if (simulation.cpu().state().fatal_code) return kCpuFatal;
  print_interruption();
  if (options.rig.failed_strictly(simulation.cpu())) {
    print_error("--strict: a run-time error ended the exchanges");
    return kCheckFailed;
  }
  return answered == frames.size() && !interrupted() ? kFine : kCheckFailed;
}

}  // namespace

void add_send(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SendOptions>();
  CLI::App* verb = app.add_subcommand("send", "put request frames on the line of a running program, print the answers");
  options->program.add_to(*verb);
  const CLI::Option* const hex = verb->add_option(
      "HEX", options->frames,
      "frames in hex, each in quotes if it has blanks: '01 03 …'; p after a byte sends it with wrong parity");
  const CLI::Option* const text =
      verb->add_option("--text", options->texts,
                       "frame of ASCII text, with \\r \\n \\t \\\\ \\' \\\" and \\xHH (repeatable)")
          ->type_name("TEXT")
          ->allow_extra_args(false);
  verb->add_option("--frames", options->frames_file,
                   "file with one frame a line, in hex, or as text in quotation marks; # begins a comment")
      ->type_name("FILE");
  verb->add_flag("--crc", options->crc, "append the Modbus CRC to each frame");
  add_duration(*verb, "--after", options->after,
               "when to send the first frame [after the first scan and 7 characters + 10 ms of silence]");
  add_duration(*verb, "--pause", options->pause, "pause between an answer and the next frame [7 characters + 10 ms]");
  add_master_options(*verb, options->master);
  options->rig.add_to(*verb);
  verb->add_flag("--timeline", options->timeline, "show what the CPU did during each exchange: characters, interrupts, XMT");
  verb->add_flag("--json", options->json, "print the exchanges and the results as JSON");
  verb->footer(fault_help() +
               "Exit code 1 when a frame was not answered; what an answer says is not judged here but by 's7200 master'.\n"
               "Example: s7200 send stl_programs/modbus_slave.stl --crc 0106000a1234 0103000a0001");
  verb->callback([options, &exit_code, verb, hex, text] {
    for (const CLI::Option* option : verb->parse_order())
      if (option == hex || option == text) options->text_is_next.push_back(option == text);
    exit_code = run_send(*options);
  });
}

}  // namespace s7200::tools
