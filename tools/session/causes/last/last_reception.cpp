#include "tools/session/causes/last/last_reception.hpp"

#include "interpreter/model/special_memory.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

/// What ends a reception, by a status or without one.
struct End {
  std::optional<TraceRecord> status{}, damaged{}, abandoned{};
};

class ReceptionFinder final : public Reader {
 public:
  ReceptionFinder(const History& history, std::size_t station, std::uint8_t port, StopToken stop_request)
      : Reader(station, stop_request), history_(history), program_(history.station(station).cpu().program()), port_(port) {}

  /// Parts of the past are played from the newest to the oldest: what ended a reception may be in a later part than its RCV.
  void begin() {
    if (end_.status || end_.abandoned) later_ = end_;
    end_ = {};
  }

  bool before(std::uint32_t op) override {
    if (is_rcv(op)) {
      in_front_ = history_.in_front();
      of_rcv_ = {};
      refused_.reset();
      executing_ = op;
    }
    return Reader::before(op);
  }

  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::CharacterReceived && record.port == port_) {
      character_ = record;
    } else if (record.kind == TraceKind::ReceiveEnd && record.port == port_) {
      if (executing_) of_rcv_.status = record;
      end_.status = record;
      end_.damaged = (record.byte & sm::message::kParity) != 0 ? character_ : std::nullopt;
    } else if (record.kind == TraceKind::RuntimeError && record.op == executing_) {
      refused_ = record.code;
    } else if (ends_silently(record) && !end_.status && !end_.abandoned) {
      end_.abandoned = record;
    }
  }

  void instruction(const InstructionRecord& record) override {
    if (record.op != executing_) return;
    executing_.reset();
    if (!record.powered) return;
    found_ = {.moment = in_front_, .by = record, .refused = refused_};
    end_ = of_rcv_;
  }

  bool found() const { return found_.has_value(); }

  std::optional<LastReception> result() const {
    if (!found_) return {};
    LastReception last = *found_;
    const End& end = end_.status || end_.abandoned ? end_ : later_;
    last.end = end.status;
    last.damaged = end.damaged;
    last.abandoned = end.abandoned;
    return last;
  }

 private:
  bool is_rcv(std::uint32_t op) const {
    return program_.ops[op].instruction->mnemonic == "RCV" && program_.ops[op][1].at == port_;
  }
  bool ends_silently(const TraceRecord& record) const {
    if (record.kind == TraceKind::ModeChange) return record.code == 0;
    return record.kind == TraceKind::PortControl && record.port == port_ && (record.byte & sm::kProtocol) != sm::kFreeport;
  }

  const History& history_;
  const Program& program_;
  std::uint8_t port_;
  Moment in_front_;
  std::optional<TraceRecord> character_{};
  std::optional<std::uint32_t> executing_{};
  End of_rcv_{}, end_{}, later_{};
  std::optional<std::uint16_t> refused_{};
  std::optional<LastReception> found_{};
};

}  // namespace

ReceptionSearch find_last_reception(History& history, std::size_t station, std::uint8_t port, StopToken stop_request) {
  const Moment start = history.now();
  ReceptionFinder finder(history, station, port, stop_request);
  const auto search = history.search_back(
      finder, start, [&] { finder.begin(); }, [&] { return finder.found(); });
  history.go_to(start);
  return {search == History::Search::Interrupted ? std::nullopt : finder.result(), search == History::Search::Interrupted};
}

}  // namespace s7200::tools
