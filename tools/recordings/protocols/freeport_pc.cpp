#include <fmt/format.h>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

ReadFrame read_freeport_pc(const RecordedFrame& frame, const RecordedFrame* open) {
  ReadFrame read;
  const Data bytes(frame.bytes);
  if (const auto command = pc_protocol::parse_command(bytes)) {
    read.direction = Direction::Request;
    read.right = true;
    read.station = command->station;
    read.text =
        fmt::format("station {}, {} {}", command->station, command->type == pc_protocol::Type::Read ? "read" : "write",
                    pc_protocol::notation(command->address));
    return read;
  }
  if (open == nullptr) {
    read.text = "neither a command nor an answer to one";
    return read;
  }
  const serial::Answer answer = pc_protocol::check_answer(open->bytes, bytes, bytes.back());
  read.direction = Direction::Answer;
  read.right = answer.verdict == serial::Verdict::Right || answer.verdict == serial::Verdict::Exception;
  if (answer.verdict == serial::Verdict::Exception)
    read.text = serial::error_text(answer.exception, pc_protocol::refusal_name(answer.exception));
  else
    read.text = !read.right ? answer.fault : answer.bytes.empty() ? "done" : serial::to_hex(answer.bytes);
  return read;
}

std::size_t first_freeport_pc_message(Data bytes, const RecordedFrame* open) {
  const std::size_t length = open == nullptr ? pc_protocol::kCommandLength : pc_protocol::kAnswerLength;
  return length <= bytes.size() ? length : 0;
}

}  // namespace

std::unique_ptr<FrameReader> freeport_pc_reader(const ChosenWords&) {
  return std::make_unique<PlainReader<read_freeport_pc, first_freeport_pc_message>>();
}

}  // namespace s7200::tools
