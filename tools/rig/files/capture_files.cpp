#include "tools/rig/files/capture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/record/pcap_capture.hpp"
#include "serial_sim/record/vcd_capture.hpp"

namespace s7200::tools {
namespace {

template <typename Sink>
std::unique_ptr<serial::WireSink> make(std::ostream& out) {
  return std::make_unique<Sink>(out);
}

struct Kind {
  std::string_view extension;  ///< written in any case
  std::string_view content;
  std::string_view name;
  std::string beginning;
  std::unique_ptr<serial::WireSink> (*make)(std::ostream&);
};

const std::array<Kind, 2>& kinds() {
  static const std::array<Kind, 2> kKinds{
      {{".vcd", "levels", "a capture of levels", std::string(serial::VcdCapture::kBeginning), make<serial::VcdCapture>},
       {".pcap", "frames", "a capture of frames", serial::PcapWriter::beginning(), make<serial::PcapCapture>}}};
  return kKinds;
}

const Kind* kind_of(const std::string& path) {
  const std::string extension = stl::lower_case(file_path(path).extension().string());
  const auto found =
      std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) { return extension == kind.extension; });
  return found == kinds().end() ? nullptr : &*found;
}

std::string why_no_kind(const std::string& path) {
  std::string known;
  for (const Kind& kind : kinds())
    known += fmt::format("{}{} ({})", known.empty() ? "" : " nor in ", kind.extension, kind.content);
  return fmt::format("--capture {}: the name ends neither in {}", path, known);
}

}  // namespace

Result<> CaptureFiles::claim(WrittenFiles& files, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const Kind* const kind = kind_of(path);
    if (!kind) return Trouble{why_no_kind(path)};
    Capture& capture = captures_.emplace_back();
    capture.make = kind->make;
    if (const auto done = capture.file.claim(files, "--capture", path, {kind->name, kind->beginning}); !done)
      return done.trouble();
  }
  return {};
}

Result<> CaptureFiles::open() {
  for (Capture& capture : captures_) {
    const auto out = capture.file.open();
    if (!out) return out.trouble();
    capture.sink = capture.make(*out);
  }
  return {};
}

Result<> CaptureFiles::put() {
  return with_each(captures_, [](Capture& capture) { return capture.file.put(); });
}

void CaptureFiles::watch(serial::ResponderStation& plc, Time from) {
  if (!captures_.empty()) plc.set_wire_sink(this, from);
}

void CaptureFiles::flush() {
  for (Capture& capture : captures_) capture.file.flush();
}

void CaptureFiles::add_sizes(std::vector<RecordSize>& sizes) const {
  for (const Capture& capture : captures_)
    if (const auto size = capture.file.size()) sizes.push_back(*size);
}

void CaptureFiles::close(std::vector<std::string>& problems) {
  finish();
  for (Capture& capture : captures_) {
    if (const auto done = capture.file.close(); !done) problems.push_back(done.why());
  }
  captures_.clear();
}

void CaptureFiles::edge(serial::Wire wire, Time at, bool mark, int driver) {
  if (at < told_until_) return;
  for (Capture& capture : captures_) capture.sink->edge(wire, at, mark, driver);
}

void CaptureFiles::settled(Time until, const SerialFormat& port) {
  if (until <= told_until_) return;
  told_until_ = until;
  for (Capture& capture : captures_) capture.sink->settled(until, line_.over(port));
}

void CaptureFiles::finish() {
  for (Capture& capture : captures_) capture.sink->finish();
}

}  // namespace s7200::tools
