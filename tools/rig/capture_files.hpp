// `--capture FILE`: where what runs over the line goes.
#pragma once

#include <list>
#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"
#include "tools/host/record_file.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Any number of captures of one line; the end of a file's name says which kind it is.
class CaptureFiles final : private serial::WireSink {
 public:
  void add_to(CLI::App& app);

  /// False after a message, like the others: a capture cannot be written as it was asked for.
  bool claim(WrittenFiles& files);
  bool open();
  bool put();

  /// Captures from now on, until close() or the end of the simulation. This object outlives the simulation.
  void watch(serial::Simulation& simulation);

  /// False after a message when not everything could be written.
  bool close();

 private:
  struct Capture {
    RecordFile file;
    std::unique_ptr<serial::WireSink> (*make)(std::ostream&) = nullptr;
    std::unique_ptr<serial::WireSink> sink;
  };

  void edge(serial::Wire wire, Time at, bool mark) override;
  void settled(Time until, const SerialFormat& port) override;
  void finish() override;

  std::vector<std::string> paths_;
  std::list<Capture> captures_;  // sinks hold on to the files' streams
};

}  // namespace s7200::tools
