// A master on a simulated line: how it asks, whoever answers there.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "serial_sim/peers/requester.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class MasterInSimulation : public SlaveInSimulation {
 public:
  /// Lets `told` be called before each request, with the format in which it is sent; after those that are told already.
  void when_asked(std::function<void(const SerialFormat& format, const serial::Request& request)> told) {
    asked_.push_back(std::move(told));
  }

  /// Runs an exchange, on a CPU in STOP too. After Ctrl-C the result is its part so far, and no further exchange can begin.
  /// Throws std::invalid_argument for a byte with wrong parity in a format without parity.
  serial::Exchange exchange(const serial::Request& request) override;
  serial::Exchange receive(const serial::Listening& listening) override;
  /// The pause that a master leaves between an answer and its next request, in the present format.
  Time pause() const override;
  std::string name() const override { return name_; }
  std::string remark() const override { return remark_; }

 protected:
  explicit MasterInSimulation(std::string name) : name_(std::move(name)) {}

  virtual serial::Requester& requester() = 0;
  /// Sets the format of the master from its next character on.
  virtual void configure(const SerialFormat& format) = 0;
  /// Runs until what the master has started is over, or a stop was asked for.
  virtual serial::Exchange run_exchange() = 0;

 private:
  serial::Exchange finish();

  std::string name_, remark_;
  std::vector<std::function<void(const SerialFormat&, const serial::Request&)>> asked_{};
};

}  // namespace s7200::tools
