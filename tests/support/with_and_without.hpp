// The same program twice: with scans passed over wherever that is possible, and without.
#pragma once

#include <tuple>

#include "tests/support/plc.hpp"

namespace s7200::test {

struct PlcThat : Plc {
  PlcThat(SteadyScansUse use, std::string_view text, const CpuModel& model = cpu214()) : Plc(text, model) {
    cpu.use_steady_scans(use);
  }
};

class Both {
 public:
  explicit Both(std::string_view text, const CpuModel& model = cpu214())
      : text_(text), with_(SteadyScansUse::Eager, text, model), without_(SteadyScansUse::Off, text, model) {}

  template <class What>
  void each(What what) {
    what(with_);
    what(without_);
  }

  /// Whether both are in the same state there, and have done the same to the outside.
  void run_until(Time end) {
    each([end](Plc& plc) { plc.run_until(end); });
    ASSERT_EQ(with_.cpu.state(), without_.cpu.state()) << "at " << end << " ns of\n" << text_;
    ASSERT_EQ(with_.queue, without_.queue) << text_;
    ASSERT_EQ(with_.records.all.size(), without_.records.all.size()) << text_;
    for (; compared_ < with_.records.all.size(); ++compared_)
      ASSERT_EQ(told(with_), told(without_)) << "at " << end << " ns of\n" << text_;
    ASSERT_LE(passed(), with_.cpu.time());
  }

  const Plc& plc() const { return with_; }
  /// Simulated time that was passed over.
  Time passed() const { return with_.cpu.passed_over(); }

 private:
  /// Of a record: what, when, and of which instruction.
  std::tuple<TraceKind, Time, std::uint32_t> told(const Plc& plc) const {
    const TraceRecord& record = plc.records.all[compared_];
    return {record.kind, record.at, record.op};
  }

  std::string text_;
  std::size_t compared_ = 0;
  PlcThat with_, without_;
};

}  // namespace s7200::test
