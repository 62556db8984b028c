// A Modbus RTU master made with libmodbus, told what to ask line by line:
//
//   open LINK BAUD           8E1
//   station NUMBER           0 is the broadcast
//   timeout MILLISECONDS
//   ask FUNCTION FIRST COUNT             1 to 4
//   ask FUNCTION FIRST VALUE...          5, 6, 15, 16
//   raw HEX                  a PDU that libmodbus itself refuses to build
//
// Each is answered by a line: `values 1 2 3` (none for writes and settings, all bytes of the frame for raw), `refused CODE`,
// `silent`, or `failed WHY`.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <modbus/modbus.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Values = std::vector<int>;

struct Close {
  void operator()(modbus_t* port) const {
    modbus_close(port);
    modbus_free(port);
  }
};

class LibmodbusMaster {
 public:
  std::string obey(const std::string& line) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "open") return open(words);
    if (!port_) return "failed: open first";
    if (what == "station") return reply(modbus_set_slave(port_.get(), number(words)), {});
    if (what == "timeout") return set_timeout(number(words));
    if (what == "ask") return ask(words);
    if (what == "raw") return raw(words);
    return "failed: unknown command";
  }

 private:
  static int number(std::istream& words) {
    int number = -1;
    words >> number;
    return number;
  }

  std::string open(std::istream& words) {
    std::string link;
    words >> link;
    port_.reset(modbus_new_rtu(link.c_str(), number(words), 'E', 8, 1));
    return reply(port_ ? modbus_connect(port_.get()) : -1, {});
  }

  std::string set_timeout(int milliseconds) {
    const auto seconds = static_cast<std::uint32_t>(milliseconds / 1000);
    const auto microseconds = static_cast<std::uint32_t>(milliseconds % 1000 * 1000);
    modbus_set_byte_timeout(port_.get(), seconds, microseconds);
    return reply(modbus_set_response_timeout(port_.get(), seconds, microseconds), {});
  }

  std::string ask(std::istream& words) {
    const int function = number(words), first = number(words);
    Values values;
    for (int value; words >> value;) values.push_back(value);
    if (values.empty()) return "failed: nothing to ask for";
    switch (function) {
      case 1:
        return read<std::uint8_t>(modbus_read_bits, first, values[0]);
      case 2:
        return read<std::uint8_t>(modbus_read_input_bits, first, values[0]);
      case 3:
        return read<std::uint16_t>(modbus_read_registers, first, values[0]);
      case 4:
        return read<std::uint16_t>(modbus_read_input_registers, first, values[0]);
      case 5:
        return reply(modbus_write_bit(port_.get(), first, values[0]), {});
      case 6:
        return reply(modbus_write_register(port_.get(), first, static_cast<std::uint16_t>(values[0])), {});
      case 15:
        return write<std::uint8_t>(modbus_write_bits, first, values);
      case 16:
        return write<std::uint16_t>(modbus_write_registers, first, values);
    }
    return "failed: no such function";
  }

  template <typename Value>
  std::string read(int (*of_libmodbus)(modbus_t*, int, int, Value*), int first, int count) {
    std::vector<Value> values(2048);
    const int got = of_libmodbus(port_.get(), first, count, values.data());
    return reply(got, Values(values.begin(), values.begin() + std::max(got, 0)));
  }

  template <typename Value>
  std::string write(int (*of_libmodbus)(modbus_t*, int, int, const Value*), int first, const Values& given) {
    std::vector<Value> values;
    for (const int value : given) values.push_back(static_cast<Value>(value));
    return reply(of_libmodbus(port_.get(), first, static_cast<int>(values.size()), values.data()), {});
  }

  std::string raw(std::istream& words) {
    std::string hex;
    words >> hex;
    std::vector<std::uint8_t> request{static_cast<std::uint8_t>(modbus_get_slave(port_.get()))};
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      std::uint8_t byte = 0;
      std::from_chars(&hex[i], &hex[i] + 2, byte, 16);
      request.push_back(byte);
    }
    if (modbus_send_raw_request(port_.get(), request.data(), static_cast<int>(request.size())) < 0) return reply(-1, {});
    std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH> answer{};
    const int length = modbus_receive_confirmation(port_.get(), answer.data());
    if (length >= 3 && (answer[1] & 0x80) != 0) return fmt::format("refused {}", answer[2]);
    return reply(length, Values(answer.begin(), answer.begin() + std::max(length, 0)));
  }

  static std::string reply(int result, const Values& values) {
    if (result >= 0) return fmt::format("values {}", fmt::join(values, " "));
    const int code = errno - MODBUS_ENOBASE;
    if (code > 0 && code < MODBUS_EXCEPTION_MAX) return fmt::format("refused {}", code);
    if (errno == ETIMEDOUT) return "silent";
    return fmt::format("failed: {}", modbus_strerror(errno));
  }

  std::unique_ptr<modbus_t, Close> port_;
};

}  // namespace

int main() {
  LibmodbusMaster master;
  for (std::string line; std::getline(std::cin, line);) std::cout << master.obey(line) << std::endl;
}
