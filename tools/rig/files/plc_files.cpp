#include "tools/rig/files/plc_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/output_record.hpp"
#include "interpreter/trace/output_waves.hpp"
#include "tools/record/trace_formats.hpp"

namespace s7200::tools {

PlcFiles::PlcFiles(const PlcPlan& plan, const serial::Plc& plc)
    : program_(plan.program), settings_(plan.settings), plc_(plc) {}

Result<> PlcFiles::claim(WrittenFiles& files) {
  files.reads(program_->source.name);
  for (const stl::FurtherFile& file : program_->source.further_files) files.reads(file.name);
  const TraceFormat& format = trace_format_of(settings_.trace);
  const auto trace = [this, &format](std::ostream& out) {
    out << format.first_line;
    const auto take = [&out](Time, std::string_view line) { out << line; };
    const auto state = [this] { return plc_.powered() ? &plc_.cpu().state() : nullptr; };
    auto made = format.writer({take, program_, settings_.trace_detail, {}, signals_of(settings_.signals, *program_), state});
    trace_ = made.get();
    return made;
  };
  if (std::string why = settings_.trace.empty() ? "" : why_not_signals(format, settings_.signals); !why.empty())
    return Trouble{std::move(why)};
  const bool waves = stl::lower_case(file_path(settings_.output).extension().string()) == ".vcd";
  const FileKind rows{"a record of outputs", fmt::format("{}\n", OutputRecord::kFirstLine)};
  const FileKind dump{"a dump of outputs", std::string(OutputWaves::kBeginning)};
  const auto output = [this, waves](std::ostream& out) -> std::unique_ptr<TraceSink> {
    if (waves) return std::make_unique<OutputWaves>(out, *program_->model);
    return std::make_unique<OutputRecord>(out);
  };
  const FileKind record{"a trace", std::string(format.first_line)};
  return memory_.claim(files, settings_.memory)
      .and_then([&] { return traces_.claim(files, "--trace", settings_.trace, record, trace); })
      .and_then([&] { return traces_.claim(files, "--output", settings_.output, waves ? dump : rows, output); });
}

Result<> PlcFiles::read_memory(std::optional<RetentiveMemory>& kept) {
  if (const auto done = memory_.read(*program_->model); !done) return done.trouble();
  if (!kept && memory_.memory()) kept = *memory_.memory();
  return {};
}

serial::WireSink* PlcFiles::levels_at(std::uint8_t port) {
  const auto is_there = [port](const Signal& signal) {
    return signal.port == port && (signal.kind == Signal::Kind::Level || signal.kind == Signal::Kind::Levels);
  };
  if (!trace_ || std::ranges::none_of(settings_.signals, is_there)) return nullptr;
  return &levels_.emplace_back(*trace_, port);
}

void PlcFiles::Levels::edge(serial::Wire wire, Time at, bool mark, int) {
  static_assert(static_cast<int>(PortLevel::Rxd) == static_cast<int>(serial::Wire::Rx) &&
                static_cast<int>(PortLevel::Txd) == static_cast<int>(serial::Wire::Tx) &&
                static_cast<int>(PortLevel::Line) == static_cast<int>(serial::Wire::Line));
  trace.level(port, static_cast<PortLevel>(wire), at, mark);
}

void PlcFiles::Levels::settled(Time until, const SerialFormat&) { trace.settled(port, until); }

void PlcFiles::keep_memory(std::vector<std::string>& problems) const {
  if (const auto done = memory_.write(plc_.cpu()); !done) problems.push_back(done.why());
}

}  // namespace s7200::tools
