// Requests of the masters that poll. They know their time-outs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/session/stops/asked_by.hpp"

namespace s7200::tools {

class AskedByPollers final : public AskedBy {
 public:
  using AskedBy::AskedBy;

  void begin(Time now, const std::vector<HeardFrames::Frame>& before) override;

  /// Between two looks one request may be over and the next under way.
  void look(Time now) override;
  Time next_timeout() const override;

 private:
  /// A master, as at the last look.
  struct Polling {
    bool asks = false;
    std::uint64_t asked = 0, answered = 0, wrong = 0;  ///< requests, with this one
    std::vector<std::uint8_t> frame{};
  };

  void look_at(std::size_t number);
  void tell_of(std::size_t number, const std::string& wrong, const std::vector<std::uint8_t>& answer) const;

  std::vector<Polling> polling_{};  ///< by master
};

}  // namespace s7200::tools
