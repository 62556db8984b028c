#include "tools/faces/dap/wire/inbox.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools::dap {
namespace {

bool ends_what_goes_on(const Json& message) {
  const std::string command = text_in(message, "command");
  return command == "pause" || command == "terminate" || command == "disconnect" || command == "restart" ||
         command == "cancel";
}

}  // namespace

/// A request to cancel one that waits takes that away, and ends nothing.
bool Inbox::is_urgent(const Json& message) {
  const Json arguments = object_in(message, "arguments");
  if (text_in(message, "command") == "cancel" && arguments.contains("requestId")) {
    const std::int64_t wanted = number_in(arguments, "requestId");
    const auto waits =
        std::ranges::find_if(messages_, [&](const Item& one) { return number_in(one.message, "seq") == wanted; });
    if (waits != messages_.end()) {
      cancelled_.insert(wanted);
      return false;
    }
  }
  return ends_what_goes_on(message);
}

void Inbox::put(Json message, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const bool urgent = is_urgent(message);
  add({std::move(message), false, bytes}, urgent);
}

bool Inbox::has_room() const {
  const std::lock_guard lock(mutex_);
  return messages_.size() < kMostMessages && bytes_ < kMostBytes;
}

void Inbox::put_unreadable(const std::string& wrong) {
  const std::lock_guard lock(mutex_);
  add({wrong, true, wrong.size()}, false);
}

void Inbox::add(Item item, bool urgent) {
  if (runs_ || urgent) stop_request_ = true;
  bytes_ += item.bytes;
  messages_.push_back(std::move(item));
  come_.notify_one();
}

void Inbox::close(const std::string& failure) {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  failure_ = failure;
  stop_request_ = true;
  come_.notify_one();
}

Inbox::Next Inbox::take(bool runs, Json& message) {
  std::unique_lock lock(mutex_);
  runs_ = runs;
  if (!runs) come_.wait(lock, [this] { return closed_ || !messages_.empty(); });
  if (messages_.empty()) {
    if (closed_) return Next::Closed;
    stop_request_ = false;
    return Next::Run;
  }
  runs_ = false;
  message = std::move(messages_.front().message);
  const bool unreadable = messages_.front().unreadable;
  bytes_ -= messages_.front().bytes;
  messages_.pop_front();
  stop_request_ = closed_ || std::ranges::any_of(messages_, ends_what_goes_on, &Item::message);
  if (unreadable) return Next::Unreadable;
  return cancelled_.erase(number_in(message, "seq")) != 0 ? Next::Cancelled : Next::Message;
}

std::string Inbox::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace s7200::tools::dap
