#include "tools/faces/page/server/inbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/json/json_text.hpp"

namespace s7200::tools::page {

void Inbox::join(Client client) {
  const std::lock_guard lock(mutex_);
  add({.kind = Incoming::Kind::Joined, .client = client});
}

void Inbox::leave(Client client) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [client](const Incoming& one) { return one.client == client; });
  add({.kind = Incoming::Kind::Left, .client = client});
}

std::string Inbox::put(Client client, const std::string& text) {
  constexpr JsonLimits kLimits{.bytes = 1 << 20};
  auto message = parse_json(text, kLimits);
  std::string why = message.why();
  if (message && !message->is_object()) why = "not a JSON object";
  const std::lock_guard lock(mutex_);
  if (const std::string full = why_full(client, text.size()); !full.empty()) return full;
  if (!why.empty()) {
    add({.kind = Incoming::Kind::Unreadable, .client = client, .message = why, .bytes = text.size()});
    return {};
  }
  if (message->contains("stop")) {
    stop_for(client);
    if (!message->contains("run")) return {};
  }
  add({.kind = Incoming::Kind::Message, .client = client, .message = std::move(*message), .bytes = text.size()});
  return {};
}

std::string Inbox::why_full(Client client, std::size_t more) const {
  std::size_t messages = 1, bytes = more;
  for (const Incoming& one : waiting_)
    if (one.client == client) {
      ++messages;
      bytes += one.bytes;
    }
  if (messages <= kMostWaiting && bytes <= kMostBytes) return {};
  return fmt::format("more than {} messages or {} MB of it are waiting", kMostWaiting, kMostBytes >> 20);
}

void Inbox::end() {
  const std::lock_guard lock(mutex_);
  ended_ = stop_ = pause_ = true;
  come_.notify_one();
}

Incoming Inbox::take() {
  std::unique_lock lock(mutex_);
  come_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
  if (ended_) return {.kind = Incoming::Kind::Ended};
  stop_ = pause_ = false;
  return first();
}

std::optional<Incoming> Inbox::take_waiting() {
  const std::lock_guard lock(mutex_);
  pause_ = ended_;
  if (ended_ || waiting_.empty()) return {};
  return first();
}

void Inbox::run_is_live(bool on) {
  const std::lock_guard lock(mutex_);
  live_ = on;
  if (on && !waiting_.empty()) pause_ = true;
}

void Inbox::add(Incoming incoming) {
  if (live_) pause_ = true;
  waiting_.push_back(std::move(incoming));
  come_.notify_one();
}

Incoming Inbox::first() {
  Incoming next = std::move(waiting_.front());
  waiting_.pop_front();
  return next;
}

void Inbox::stop_for(Client client) {
  stop_ = pause_ = true;
  for (Incoming& one : waiting_)
    if (one.client == client && one.kind == Incoming::Kind::Message) one.undone = true;
}

}  // namespace s7200::tools::page
