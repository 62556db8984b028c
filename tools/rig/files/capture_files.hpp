// The captures of a line while it runs: its levels and its frames.
#pragma once

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/line/line_settings.hpp"
#include "serial_sim/system/plc.hpp"
#include "serial_sim/system/stations.hpp"
#include "tools/host/files/record_file.hpp"

namespace s7200::tools {

/// The captures of one line, any number of them; the end of a file's name determines its kind. Instants that run again after
/// the simulation has been restored are not captured again.
class CaptureFiles final : private serial::WireSink {
 public:
  /// Trouble if a capture cannot be written as it was asked for.
  Result<> claim(WrittenFiles& files, const std::vector<std::string>& paths);
  Result<> open();
  Result<> put();

  /// Writes the captures so far to their files.
  void flush();

  /// Reads the line by the settings in the line's file instead of the settings of the watched port.
  void read_as(const serial::LineSettings& line) { line_ = line; }

  /// What is told of the wires at a port, so that they are captured until close(); null without captures.
  serial::WireSink* sink() { return captures_.empty() ? nullptr : this; }

  /// Captures the line at the port of a PLC of another make.
  void watch(serial::ResponderStation& plc, Time from);

  /// Adds how far they have grown.
  void add_sizes(std::vector<RecordSize>& sizes) const;

  /// Closes all of them; adds to `problems` what could not be written.
  void close(std::vector<std::string>& problems);

 private:
  struct Capture {
    RecordFile file;
    std::unique_ptr<serial::WireSink> (*make)(std::ostream&) = nullptr;
    std::unique_ptr<serial::WireSink> sink;
  };

  void edge(serial::Wire wire, Time at, bool mark, int driver) override;
  void settled(Time until, const SerialFormat& port) override;
  void finish() override;

  serial::LineSettings line_;
  std::list<Capture> captures_;  // sinks hold on to the files' streams
  Time told_until_ = 0;
};

}  // namespace s7200::tools
