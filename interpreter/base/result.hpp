// What a call brings: a value, or why there is none.
#pragma once

#include <fmt/core.h>

#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace s7200 {

/// Why there is no value, in words for the user. Empty where there is nothing to say to him: after a stop that he asked for.
struct Trouble {
  std::string why{};
};

/// `return trouble("'{}' is not a port", text);`
template <class... Args>
[[nodiscard]] Trouble trouble(fmt::format_string<Args...> format, Args&&... args) {
  return {fmt::format(format, std::forward<Args>(args)...)};
}

/// A value, or the trouble that there was. It has no value by itself, so that `return {};` does not compile. A trouble goes
/// on with `if (!read) return read.trouble();`, and with where it was by `return trouble("cannot read {}: {}", path,
/// read.why());`.
template <class T = void>
class [[nodiscard]] Result {
 public:
  template <class U = T>
  requires std::is_convertible_v<U&&, T> Result(U&& value) : value_(std::forward<U>(value)) {}
  Result(Trouble trouble) : trouble_(std::move(trouble)) {}
  Result(std::nullopt_t) {}         ///< no value, and nothing to say
  Result(std::nullptr_t) = delete;  ///< of a pointer that may be null it would not be known whether it means trouble

  bool has_value() const { return value_.has_value(); }
  explicit operator bool() const { return has_value(); }

  /// There must be one.
  T& value() & { return *checked().value_; }
  const T& value() const& { return *checked().value_; }
  T&& value() && { return *std::move(checked().value_); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  template <class U>
  T value_or(U&& other) const& {
    return value_.value_or(std::forward<U>(other));
  }
  template <class U>
  T value_or(U&& other) && {
    return std::move(value_).value_or(std::forward<U>(other));
  }

  /// Goes on with what takes the value and brings a result too, unless there was trouble.
  template <class Next>
  std::invoke_result_t<Next, const T&> and_then(Next next) const {
    if (!value_) return trouble_;
    return next(*value_);
  }

  /// For whoever does not ask why.
  std::optional<T> if_any() const& { return value_; }
  std::optional<T> if_any() && { return std::move(value_); }

  /// Empty with a value, and as Trouble says.
  const std::string& why() const { return trouble_.why; }
  /// For a result of another type.
  Trouble trouble() const { return trouble_; }

  friend bool operator==(const Result& result, const T& value) { return result.value_ == value; }

 private:
  Result& checked() {
    assert(value_);
    return *this;
  }
  const Result& checked() const {
    assert(value_);
    return *this;
  }

  std::optional<T> value_;
  Trouble trouble_;
};

/// Something that lives elsewhere, or the trouble that there was.
template <class T>
class [[nodiscard]] Result<T&> {
 public:
  Result(T& value) : value_(&value) {}
  Result(Trouble trouble) : trouble_(std::move(trouble)) {}

  explicit operator bool() const { return value_ != nullptr; }
  T& operator*() const { return *value_; }
  T* operator->() const { return value_; }
  const std::string& why() const { return trouble_.why; }
  Trouble trouble() const { return trouble_; }

 private:
  T* value_ = nullptr;
  Trouble trouble_;
};

/// Of a call that brings no value: whether it did what it was to do. `return {};` says so.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Trouble trouble) : trouble_(std::move(trouble)) {}

  explicit operator bool() const { return !trouble_.has_value(); }

  /// Goes on with what brings such a result too, unless there was trouble.
  template <class Next>
  Result and_then(Next next) const {
    return trouble_ ? *this : next();
  }

  const std::string& why() const {
    static const std::string kNothing;
    return trouble_ ? trouble_->why : kNothing;
  }
  Trouble trouble() const { return trouble_.value_or(Trouble{}); }

 private:
  std::optional<Trouble> trouble_;
};

/// Does it with each of them; ends with the first trouble.
template <class All, class Do>
Result<> with_each(All& all, Do do_it) {
  for (auto& each : all)
    if (Result<> done = do_it(each); !done) return done;
  return {};
}

}  // namespace s7200
