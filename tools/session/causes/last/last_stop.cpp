#include "tools/session/causes/last/last_stop.hpp"

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

struct StopFinder final : Reader {
  using Reader::Reader;
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ModeChange && record.code == 0) at = record.at;
  }
  std::optional<Time> at{};
};

}  // namespace

std::optional<Time> find_last_stop(History& history, std::size_t station, StopToken stop_request) {
  const Moment start = history.now();
  StopFinder finder(station, stop_request);
  history.search_back(
      finder, start, [] {}, [&] { return finder.at.has_value(); });
  history.go_to(start);
  return finder.at;
}

}  // namespace s7200::tools
