#include "tools/rig/capture_files.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "serial_sim/record/pcap_capture.hpp"
#include "serial_sim/record/vcd_capture.hpp"
#include "tools/host/terminal.hpp"

namespace s7200::tools {
namespace {

template <typename Sink>
std::unique_ptr<serial::WireSink> make(std::ostream& out) {
  return std::make_unique<Sink>(out);
}

struct Kind {
  std::string_view extension;
  std::string_view name;
  std::string beginning;
  std::unique_ptr<serial::WireSink> (*make)(std::ostream&);
};

const std::array<Kind, 2>& kinds() {
  static const std::array<Kind, 2> kKinds{
      {{".vcd", "a capture of levels", std::string(serial::VcdCapture::kBeginning), make<serial::VcdCapture>},
       {".pcap", "a capture of frames", serial::PcapWriter::beginning(), make<serial::PcapCapture>}}};
  return kKinds;
}

const Kind* kind_of(const std::string& path) {
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) {
    return std::filesystem::path(path).extension() == kind.extension;
  });
  return found == kinds().end() ? nullptr : &*found;
}

}  // namespace

void CaptureFiles::add_to(CLI::App& app) {
  app.add_option("--capture", paths_,
                 "write the line to FILE.vcd (levels of rx and tx, for sigrok) or FILE.pcap (frames, for Wireshark); "
                 "repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

bool CaptureFiles::claim(WrittenFiles& files) {
  for (const std::string& path : paths_) {
    const Kind* const kind = kind_of(path);
    if (!kind) print_error(fmt::format("--capture {}: the name ends neither in .vcd (levels) nor in .pcap (frames)", path));
    if (!kind) return false;
    Capture& capture = captures_.emplace_back();
    capture.make = kind->make;
    if (!capture.file.claim(files, "--capture", path, {kind->name, kind->beginning})) return false;
  }
  return true;
}

bool CaptureFiles::open() {
  for (Capture& capture : captures_) {
    std::ostream* out = capture.file.open();
    if (!out) return false;
    capture.sink = capture.make(*out);
  }
  return true;
}

bool CaptureFiles::put() {
  return std::all_of(captures_.begin(), captures_.end(), [](Capture& capture) { return capture.file.put(); });
}

void CaptureFiles::watch(serial::Simulation& simulation) {
  if (!captures_.empty()) simulation.set_wire_sink(this);
}

bool CaptureFiles::close() {
  finish();
  bool good = true;
  for (Capture& capture : captures_) good &= capture.file.close();
  captures_.clear();
  return good;
}

void CaptureFiles::edge(serial::Wire wire, Time at, bool mark) {
  for (Capture& capture : captures_) capture.sink->edge(wire, at, mark);
}

void CaptureFiles::settled(Time until, const SerialFormat& port) {
  for (Capture& capture : captures_) capture.sink->settled(until, port);
}

void CaptureFiles::finish() {
  for (Capture& capture : captures_) capture.sink->finish();
}

}  // namespace s7200::tools
