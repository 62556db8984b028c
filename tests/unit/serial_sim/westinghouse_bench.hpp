// A simulated PLC of the Westinghouse family and a master on one line; and exchanges as files have them, played on it.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "serial_sim/system/system.hpp"
#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::westinghouse {

class Bench {
 public:
  /// The PLC that speaks a protocol, in its bench state, with these settings: `key=modify W[4000]=1234`.
  explicit Bench(std::string_view protocol, const std::string& settings = {});

  void set(const std::string& settings);

  /// Sends a frame in hex, and returns the answer in hex; empty if none began within `timeout`.
  std::string ask(const std::string& hex, bool sync = false, Time timeout = 60 * kMillisecond);

  /// Of the PLC, for a while.
  void lose_power();

  void wait(Time time) { system_.run_until(system_.time() + time); }

  /// Empty if the PLC holds what the texts say; otherwise what it holds.
  std::string fault_of(const std::string& texts) const;

  Plc& plc() { return dynamic_cast<Plc&>(station_.responder().automaton()); }
  const Plc& plc() const { return dynamic_cast<const Plc&>(station_.responder().automaton()); }
  serial::System& system() { return system_; }
  serial::SharedLine& line() { return line_; }
  serial::ResponderStation& station() { return station_; }
  serial::RequesterStation& master() { return master_; }

 private:
  serial::System system_;
  serial::SharedLine& line_;
  serial::ResponderStation& station_;
  serial::RequesterStation& master_;
};

/// A record of a file of exchanges: see ../shared/reference/westinghouse_vectors.txt.
struct ExchangeRecord {
  std::string id, protocol, state, steps;
};

std::vector<ExchangeRecord> read_exchanges(const std::string& text);

/// Plays a record, and those it goes on from before.
void play(const ExchangeRecord& record, const std::map<std::string, ExchangeRecord>& all);

/// Plays all records of a file that are of `protocol`. How many there were.
int play_file(const std::string& text, const std::string& protocol);

/// The text of a file relative to the top of the tree; empty if it is not there.
std::string text_of(const std::string& path);

}  // namespace s7200::westinghouse
