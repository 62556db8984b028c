// What looks at a past that is played again.
#pragma once

#include <atomic>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Sees every instruction, until a stop is asked for.
class Reader : public Observer {
 public:
  /// Of all stations. `stop_request` may be null; it is not owned.
  explicit Reader(const std::atomic<bool>* stop_request) : stop_request_(stop_request) {}
  /// Of one station alone.
  Reader(std::size_t station, const std::atomic<bool>* stop_request) : Observer(station), stop_request_(stop_request) {}

  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !(stop_request_ && *stop_request_); }

 private:
  const std::atomic<bool>* stop_request_;
};

}  // namespace s7200::tools
