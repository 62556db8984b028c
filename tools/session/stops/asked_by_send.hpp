// Requests of the simulated masters, which `send` puts on the lines. They know their time-outs.
#pragma once

#include <vector>

#include "tools/session/stops/asked_by.hpp"

namespace s7200::tools {

class AskedBySend final : public AskedBy {
 public:
  using AskedBy::AskedBy;

  /// Which of the masters are asking; of those take_finished() tells.
  void await();
  void await_none() { awaited_.clear(); }

  /// The stations at whose masters an exchange is over that was awaited: it has its answer, or none has come.
  std::vector<std::size_t> take_finished();

  void begin(Time, const std::vector<HeardFrames::Frame>&) override {}
  void look(Time) override {}
  Time next_timeout() const override;

 private:
  std::vector<std::size_t> awaited_{};  ///< stations whose master asks; of those with the same one the first
};

}  // namespace s7200::tools
