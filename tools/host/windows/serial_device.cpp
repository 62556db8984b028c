#include "tools/host/serial_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <mutex>
#include <thread>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

/// COM3 and \\.\COM12 are the same kind of name, and from COM10 on only the second is one that a file can be opened by.
constexpr std::string_view kDevices = "\\\\.\\";

/// The port that a word names, COM3; empty if it is none. `mode COM3:` writes a colon behind it.
std::string port_named(std::string_view word) {
  std::string name = stl::upper_case(word.starts_with(kDevices) ? word.substr(kDevices.size()) : word);
  name.erase(name.find_last_not_of(": ") + 1);
  const bool is_port =
      name.starts_with("COM") && name.size() > 3 && name.find_first_not_of("0123456789", 3) == std::string::npos;
  return is_port ? name : "";
}

/// The COM ports of this computer, for whoever has named another: `COM1 and COM3`.
std::string ports_there_are() {
  std::array<wchar_t, 65'536> names{};
  const DWORD length = QueryDosDeviceW(nullptr, names.data(), static_cast<DWORD>(names.size()));
  std::vector<std::string> ports;
  for (std::size_t begin = 0; begin < length && names[begin] != L'\0';) {
    const std::wstring_view name(names.data() + begin);
    if (!port_named(utf8(name)).empty()) ports.push_back(utf8(name));
    begin += name.size() + 1;
  }
  std::ranges::sort(ports, {}, [](const std::string& port) { return std::pair(port.size(), port); });
  if (ports.empty()) return "this computer has no COM port; is the adapter plugged in?";
  std::string text = "this computer has ";
  for (std::size_t i = 0; i < ports.size(); ++i) text += (i == 0 ? "" : i + 1 < ports.size() ? ", " : " and ") + ports[i];
  return text;
}

std::string why_not_opened(DWORD error) {
  switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
      return "there is no such port; " + ports_there_are();
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
      return "another program has it open";
    default:
      return words_of(error);
  }
}

/// Why a port that was open does nothing any more. Drivers of adapters differ in what they say when those are pulled out.
std::string why_gone(DWORD error) {
  switch (error) {
    case ERROR_HANDLE_EOF:
    case ERROR_ACCESS_DENIED:
    case ERROR_OPERATION_ABORTED:
    case ERROR_BAD_COMMAND:
    case ERROR_GEN_FAILURE:
    case ERROR_DEVICE_REMOVED:
      return "it was unplugged";
    default:
      return words_of(error);
  }
}

DCB settings_of(const SerialFormat& format) {
  DCB settings{};
  settings.DCBlength = sizeof settings;
  settings.BaudRate = format.baud;
  settings.ByteSize = static_cast<BYTE>(format.data_bits);
  settings.fBinary = TRUE;
  settings.fParity = format.parity != Parity::None;
  settings.Parity = format.parity == Parity::None ? NOPARITY : format.parity == Parity::Odd ? ODDPARITY : EVENPARITY;
  settings.StopBits = format.stop_bits == 2 ? TWOSTOPBITS : ONESTOPBIT;
  settings.fDtrControl = DTR_CONTROL_ENABLE;
  settings.fRtsControl = RTS_CONTROL_ENABLE;
  return settings;
}

Handle event(bool set) { return Handle(CreateEventW(nullptr, TRUE, set ? TRUE : FALSE, nullptr)); }

DWORD milliseconds(std::chrono::nanoseconds time) {
  return static_cast<DWORD>(std::chrono::ceil<std::chrono::milliseconds>(time).count());
}

}  // namespace

bool names_serial_device(const std::string& word) { return !port_named(word).empty(); }

std::string_view example_of_serial_device() { return "COM3"; }

bool has_ptys() { return false; }

/// A thread reads: it waits for one character, and takes what else has come in by then. Writing is overlapped, one stretch
/// at a time.
struct SerialDevice::System {
  explicit System(Handle opened)
      : port(std::move(opened)), readable(event(false)), written(event(true)), read_done(event(false)), end(event(false)) {}
  ~System() {
    SetEvent(end.get());
    if (reader.joinable()) reader.join();
    if (is_writing) {
      CancelIoEx(port.get(), &writing);
      DWORD count = 0;
      GetOverlappedResult(port.get(), &writing, &count, TRUE);
    }
    if (has_found) SetCommState(port.get(), &found);
  }
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  void start() {
    reader = std::thread([this] { read_all(); });
  }

  void read_all() {
    std::array<std::uint8_t, kMostAtOnce> bytes{};
    for (;;) {
      if (!read(std::span(bytes).first(1))) return;
      std::size_t count = 1;
      DWORD errors = 0;
      COMSTAT state{};
      if (ClearCommError(port.get(), &errors, &state) == 0) return gone(GetLastError());
      if (const std::size_t more = std::min<std::size_t>(state.cbInQue, bytes.size() - 1); more > 0) {
        if (!read(std::span(bytes).subspan(1, more))) return;
        count += more;
      }
      put(std::span(bytes).first(count), (errors & (CE_RXPARITY | CE_FRAME | CE_BREAK)) != 0);
    }
  }

  /// Waits until all of it is filled. False at the end of the device, or of us.
  bool read(std::span<std::uint8_t> into) {
    OVERLAPPED reading{};
    reading.hEvent = read_done.get();
    ResetEvent(read_done.get());
    DWORD count = 0;
    if (ReadFile(port.get(), into.data(), static_cast<DWORD>(into.size()), nullptr, &reading) == 0 &&
        GetLastError() != ERROR_IO_PENDING)
      return gone(GetLastError()), false;
    const std::array<HANDLE, 2> waiting{read_done.get(), end.get()};
    if (WaitForMultipleObjects(static_cast<DWORD>(waiting.size()), waiting.data(), FALSE, INFINITE) != WAIT_OBJECT_0) {
      CancelIoEx(port.get(), &reading);
      GetOverlappedResult(port.get(), &reading, &count, TRUE);
      return false;
    }
    if (GetOverlappedResult(port.get(), &reading, &count, FALSE) == 0) return gone(GetLastError()), false;
    if (count == into.size()) return true;
    return gone(ERROR_HANDLE_EOF), false;
  }

  void put(std::span<const std::uint8_t> bytes, bool error) {
    const std::lock_guard lock(mutex);
    for (const std::uint8_t byte : bytes) come_in.push_back({byte, false});
    if (error) come_in.back().error = true;
    SetEvent(readable.get());
  }

  void gone(DWORD error) {
    const std::lock_guard lock(mutex);
    end_of_port = why_gone(error);
    SetEvent(readable.get());
  }

  Handle port;
  Handle readable, written, read_done, end;
  DCB found{};
  bool has_found = false;
  OVERLAPPED writing{};
  bool is_writing = false;
  std::vector<std::uint8_t> on_the_way{};
  std::mutex mutex{};  ///< guards the two that follow
  std::deque<Character> come_in{};
  std::string end_of_port{};  ///< why it does nothing any more
  std::thread reader{};
};

SerialDevice::SerialDevice() = default;
SerialDevice::SerialDevice(SerialDevice&& other) noexcept = default;
SerialDevice::~SerialDevice() = default;

Result<SerialDevice> SerialDevice::open(const std::string& path, const SerialFormat& format) {
  const std::string port_name = port_named(path);
  if (port_name.empty()) return Trouble{"it is not a COM port; " + ports_there_are()};
  const std::string name = std::string(kDevices) + port_name;
  Handle port(CreateFileW(wide(name).c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_EXISTING, FILE_FLAG_OVERLAPPED,
                          nullptr));
  if (!port) return Trouble{why_not_opened(GetLastError())};
  SerialDevice device;
  device.system_ = std::make_unique<System>(std::move(port));
  System& system = *device.system_;
  system.found.DCBlength = sizeof system.found;
  system.has_found = GetCommState(system.port.get(), &system.found) != 0;
  if (!system.has_found) return Trouble{"it is not a serial port"};
  COMMTIMEOUTS none{};  // a read waits for what it asks for, a write for nothing
  SetCommTimeouts(system.port.get(), &none);
  if (const auto done = device.set(format); !done) return done.trouble();
  device.discard_input();
  system.start();
  return device;
}

Result<> SerialDevice::set(const SerialFormat& format) {
  DCB wanted = settings_of(format);
  if (SetCommState(system_->port.get(), &wanted) == 0) {
    const DWORD error = GetLastError();
    return Trouble{error == ERROR_INVALID_PARAMETER
                       ? fmt::format("the device does not do {} baud with {} data bits, this parity and {} stop bits",
                                     format.baud, format.data_bits, format.stop_bits)
                       : words_of(error)};
  }
  format_ = format;
  return {};
}

std::intptr_t SerialDevice::native() const { return reinterpret_cast<std::intptr_t>(system_->readable.get()); }

bool SerialDevice::wait_for_input(std::chrono::nanoseconds at_most) const {
  return WaitForSingleObject(system_->readable.get(), milliseconds(at_most)) == WAIT_OBJECT_0;
}

bool SerialDevice::wait_for_room(std::chrono::nanoseconds at_most) const {
  return WaitForSingleObject(system_->written.get(), milliseconds(at_most)) == WAIT_OBJECT_0;
}

bool SerialDevice::drive_dtr(bool high) { return EscapeCommFunction(system_->port.get(), high ? SETDTR : CLRDTR) != 0; }

void SerialDevice::drain() {
  constexpr DWORD kPatience = 5000;  // ms, as everywhere with a side that takes nothing
  WaitForSingleObject(system_->written.get(), kPatience);
  FlushFileBuffers(system_->port.get());
}

Result<> SerialDevice::read(std::vector<Character>& characters) {
  System& system = *system_;
  const std::lock_guard lock(system.mutex);
  const auto count = static_cast<std::ptrdiff_t>(std::min(system.come_in.size(), kMostAtOnce));
  characters.insert(characters.end(), system.come_in.begin(), system.come_in.begin() + count);
  system.come_in.erase(system.come_in.begin(), system.come_in.begin() + count);
  if (system.come_in.empty() && system.end_of_port.empty()) ResetEvent(system.readable.get());
  if (count > 0 || system.end_of_port.empty()) return {};
  return Trouble{system.end_of_port};
}

Result<std::size_t> SerialDevice::write(std::span<const std::uint8_t> bytes) {
  System& system = *system_;
  DWORD count = 0;
  const auto fail = [](DWORD error) -> Result<std::size_t> { return Trouble{why_gone(error)}; };
  if (system.is_writing) {
    if (GetOverlappedResult(system.port.get(), &system.writing, &count, FALSE) == 0)
      return GetLastError() == ERROR_IO_INCOMPLETE ? Result<std::size_t>(0) : fail(GetLastError());
    system.is_writing = false;
  }
  if (bytes.empty()) return 0;
  system.on_the_way.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), kMostAtOnce)));
  system.writing = {};
  system.writing.hEvent = system.written.get();
  ResetEvent(system.written.get());
  if (WriteFile(system.port.get(), system.on_the_way.data(), static_cast<DWORD>(system.on_the_way.size()), nullptr,
                &system.writing) == 0 &&
      GetLastError() != ERROR_IO_PENDING) {
    const DWORD error = GetLastError();
    SetEvent(system.written.get());
    return fail(error);
  }
  system.is_writing = true;
  return system.on_the_way.size();
}

void SerialDevice::discard_input() {
  PurgeComm(system_->port.get(), PURGE_RXCLEAR);
  const std::lock_guard lock(system_->mutex);
  system_->come_in.clear();
  if (system_->end_of_port.empty()) ResetEvent(system_->readable.get());
}

}  // namespace s7200::tools
