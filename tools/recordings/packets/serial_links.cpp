#include "tools/recordings/packets/serial_links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

// Link types of captures. Source: tcpdump.org, LINKTYPE_ values.
constexpr int kFirstUser = 147, kLastUser = 162, kUsbLinux = 189, kUsbLinuxMmapped = 220, kUsbPcap = 249, kRtac = 250;

constexpr std::uint8_t kBulk = 3, kControl = 2;

std::uint16_t little16(Data data, std::size_t at) { return static_cast<std::uint16_t>(data[at] | data[at + 1] << 8); }

// --- USB: heads of packets ---

/// Source: Documentation/usb/usbmon of Linux; the head with the place in the ring has 64 bytes.
std::optional<UsbTransfer> transfer_of_linux(Data packet, std::size_t head) {
  constexpr std::size_t kType = 8, kTransfer = 9, kEndpoint = 10, kDevice = 11, kBus = 12, kSetupFlag = 14, kSetup = 40;
  if (packet.size() < head) return {};
  UsbTransfer transfer{.device = std::uint32_t{little16(packet, kBus)} << 16 | packet[kDevice],
                       .is_bulk = packet[kTransfer] == kBulk,
                       .is_control = packet[kTransfer] == kControl,
                       .in = (packet[kEndpoint] & 0x80) != 0,
                       .completed = packet[kType] == 'C',
                       .data = packet.subspan(head)};
  if (packet[kSetupFlag] == 0) transfer.setup = packet.subspan(kSetup, 8);
  return transfer;
}

/// Source: the description of USBPcap's capture format.
std::optional<UsbTransfer> transfer_of_usbpcap(Data packet) {
  constexpr std::size_t kHead = 27, kInfo = 16, kBus = 17, kDevice = 19, kEndpoint = 21, kTransfer = 22, kStage = 27,
                        kSetup = 8;
  if (packet.size() < kHead || little16(packet, 0) < kHead || little16(packet, 0) > packet.size()) return {};
  const std::size_t head = little16(packet, 0);
  UsbTransfer transfer{.device = std::uint32_t{little16(packet, kBus)} << 16 | little16(packet, kDevice),
                       .is_bulk = packet[kTransfer] == kBulk,
                       .is_control = packet[kTransfer] == kControl,
                       .in = (packet[kEndpoint] & 0x80) != 0,
                       .completed = (packet[kInfo] & 1) != 0,
                       .data = packet.subspan(head)};
  const bool is_setup = transfer.is_control && head > kStage && packet[kStage] == 0 && transfer.data.size() >= kSetup;
  if (is_setup) transfer.setup = transfer.data.first(kSetup), transfer.data = transfer.data.subspan(kSetup);
  return transfer;
}

// --- USB: which adapter it is ---

constexpr std::string_view kFtdi = "FTDI", kCp210x = "CP210x", kCh340 = "CH340", kPl2303 = "PL2303", kCdc = "CDC-ACM";

struct Vendor {
  std::uint16_t number;
  std::string_view kind;
};
constexpr std::array kVendors{Vendor{0x0403, kFtdi}, Vendor{0x10C4, kCp210x}, Vendor{0x1A86, kCh340},
                              Vendor{0x067B, kPl2303}};

/// Requests that only the driver of such an adapter makes: the rate, the format, modem lines. Source: drivers of Linux,
/// ftdi_sio, cp210x, ch341, cdc-acm.
struct DriverRequest {
  std::uint8_t type, first, last;  ///< bmRequestType, and bRequest from first to last
  std::string_view kind;
};
constexpr std::array kDriverRequests{
    DriverRequest{0x40, 0x00, 0x09, kFtdi},   DriverRequest{0xC0, 0x05, 0x05, kFtdi},
    DriverRequest{0x41, 0x00, 0x1E, kCp210x}, DriverRequest{0x40, 0x9A, 0xA4, kCh340},
    DriverRequest{0xC0, 0x95, 0x95, kCh340},  DriverRequest{0x21, 0x20, 0x23, kCdc},
};

/// A device descriptor names the vendor; a configuration has interfaces of the class for communication.
std::string_view kind_of_descriptor(Data data) {
  constexpr std::size_t kDeviceLength = 18, kVendor = 8, kInterfaceClass = 5;
  constexpr std::uint8_t kDevice = 1, kConfiguration = 2, kInterface = 4, kCommunication = 2;
  if (data.size() >= kDeviceLength && data[0] == kDeviceLength && data[1] == kDevice) {
    const auto vendor = std::ranges::find(kVendors, little16(data, kVendor), &Vendor::number);
    return vendor == kVendors.end() ? "" : vendor->kind;
  }
  if (data.size() < 2 || data[1] != kConfiguration) return "";
  for (std::size_t at = 0; at + kInterfaceClass < data.size() && data[at] != 0; at += data[at])
    if (data[at + 1] == kInterface && data[at + kInterfaceClass] == kCommunication) return kCdc;
  return "";
}

std::string_view kind_of_request(Data setup) {
  for (const DriverRequest& request : kDriverRequests)
    if (setup[0] == request.type && setup[1] >= request.first && setup[1] <= request.last) return request.kind;
  return "";
}

/// Modem status, whose bit 0 is always 1, and line status with the transmitter empty. Source: ftdi_sio.
bool may_be_status(Data packet) {
  constexpr std::uint8_t kReserved = 0x0F, kOne = 0x01, kLine = 0xE0, kEmpty = 0x60;
  return packet.size() >= 2 && (packet[0] & kReserved) == kOne && (packet[1] & kLine) == kEmpty;
}

/// The size of the packets on the bus within a transfer: FTDI puts its status before each of them.
std::size_t packet_size_of(Data data) {
  constexpr std::size_t kFullSpeed = 64, kHighSpeed = 512;
  for (std::size_t at = kFullSpeed; at < data.size(); at += kFullSpeed)
    if (data.size() - at < 2 || (data[at] & 0x0F) != 1) return kHighSpeed;
  return kFullSpeed;
}

struct Received {
  Bytes bytes{};
  bool damaged = false;
};
Received without_status(Data data) {
  constexpr std::uint8_t kErrors = 0x1E;  // overrun, parity, framing, break
  Received received;
  const std::size_t size = packet_size_of(data);
  for (std::size_t at = 0; at < data.size(); at += size) {
    const Data packet = data.subspan(at, std::min(size, data.size() - at));
    if (packet.size() < 2) break;
    received.damaged |= packet.size() > 2 && (packet[1] & kErrors) != 0;
    received.bytes.insert(received.bytes.end(), packet.begin() + 2, packet.end());
  }
  return received;
}

std::string name_of_device(std::uint32_t device) { return fmt::format("{}.{}", device >> 16, device & 0xFFFF); }

bool has_bytes(const UsbAdapter& adapter) {
  const std::size_t status = adapter.has_status ? 2 : 0;
  return std::ranges::any_of(adapter.moved, [&](const auto& each) { return each.bytes.size() > (each.in ? status : 0); });
}

void add_frames(UsbAdapter& adapter, std::vector<RecordedFrame>& frames) {
  for (UsbAdapter::Moved& moved : adapter.moved) {
    Received received =
        moved.in && adapter.has_status ? without_status(moved.bytes) : Received{.bytes = std::move(moved.bytes)};
    if (received.bytes.empty()) continue;
    RecordedFrame frame{.at = moved.at,
                        .direction = moved.in ? Direction::Answer : Direction::Request,
                        .bytes = std::move(received.bytes),
                        .place = std::move(moved.place)};
    for (std::size_t i = 0; received.damaged && i < frame.bytes.size(); ++i) frame.damaged.push_back(i);
    frames.push_back(std::move(frame));
  }
}

}  // namespace

bool SerialLinks::carry(int link_type) {
  return (link_type >= kFirstUser && link_type <= kLastUser) || link_type == kUsbLinux || link_type == kUsbLinuxMmapped ||
         link_type == kUsbPcap || link_type == kRtac;
}

void SerialLinks::take(const std::string& place, Time at, int link_type, Data packet) {
  constexpr std::size_t kLinuxHead = 48, kMmappedHead = 64;
  if (link_type == kRtac) return take_rtac(place, at, packet);
  if (link_type >= kFirstUser && link_type <= kLastUser) {
    if (!packet.empty()) frames_.push_back({.at = at, .bytes = Bytes(packet.begin(), packet.end()), .place = place});
    return;
  }
  const auto transfer = link_type == kUsbPcap
                            ? transfer_of_usbpcap(packet)
                            : transfer_of_linux(packet, link_type == kUsbLinux ? kLinuxHead : kMmappedHead);
  if (transfer)
    take(place, at, *transfer);
  else
    ++short_;
}

/// Source: tcpdump.org, LINKTYPE_RTAC_SERIAL, and the names of Wireshark's dissector `rtacser`.
void SerialLinks::take_rtac(const std::string& place, Time at, Data packet) {
  enum : std::uint8_t {
    kSent = 1,
    kReceived = 2,
    kSentEnd = 3,
    kReceivedEnd = 4,
    kLost = 5,
    kFraming = 7,
    kParity = 8,
    kOverflow = 10
  };
  constexpr std::size_t kHead = 12, kEvent = 8;
  is_log_ = true;
  if (packet.size() < kHead) return void(++short_);
  const std::uint8_t event = packet[kEvent];
  const Data data = packet.subspan(kHead);
  const bool sent = event == kSent || event == kSentEnd, received = event == kReceived || event == kReceivedEnd;
  if ((sent || received) && !data.empty()) {
    frames_.push_back({.at = at,
                       .direction = sent ? Direction::Request : Direction::Answer,
                       .bytes = Bytes(data.begin(), data.end()),
                       .place = place});
  } else if (event == kFraming || event == kParity) {
    notes_.push_back(
        fmt::format("{}: a {} error; it does not say of which character", place, event == kFraming ? "framing" : "parity"));
  } else if (event == kLost || event == kOverflow) {
    notes_.push_back(fmt::format("{}: characters were lost", place));
    if (!frames_.empty()) frames_.back().more_was_lost = true;
  }
}

void SerialLinks::take(const std::string& place, Time at, const UsbTransfer& transfer) {
  is_log_ = true;
  UsbAdapter& adapter = adapters_[transfer.device];
  if (transfer.is_control) {
    std::string_view kind;
    if (!transfer.setup.empty() && !transfer.completed) kind = kind_of_request(transfer.setup);
    if (kind.empty()) kind = kind_of_descriptor(transfer.data);
    if (adapter.kind.empty() || kind == kFtdi) adapter.kind = kind;
  }
  const bool moves = transfer.is_bulk && transfer.in == transfer.completed && !transfer.data.empty();
  if (!moves) return;
  constexpr std::array<std::uint8_t, 4> kCommandOfDisk{'U', 'S', 'B', 'C'};
  adapter.stores_data |= !transfer.in && transfer.data.size() >= kCommandOfDisk.size() &&
                         std::ranges::equal(transfer.data.first(kCommandOfDisk.size()), kCommandOfDisk);
  if (transfer.in) adapter.may_be_status &= may_be_status(transfer.data);
  adapter.moved.push_back(
      {.at = at, .in = transfer.in, .bytes = Bytes(transfer.data.begin(), transfer.data.end()), .place = place});
}

Result<> SerialLinks::finish(LineRecording& recording) {
  std::vector<std::uint32_t> known, unknown;
  for (auto& [device, adapter] : adapters_) {
    const bool answers = std::ranges::any_of(adapter.moved, &UsbAdapter::Moved::in);
    const bool as_ftdi = adapter.kind.empty() && answers && adapter.may_be_status;
    adapter.has_status = adapter.kind == kFtdi || as_ftdi;
    if (adapter.stores_data || !has_bytes(adapter)) continue;
    (adapter.kind.empty() && !as_ftdi ? unknown : known).push_back(device);
  }
  const std::vector<std::uint32_t>& lines = known.empty() ? unknown : known;
  if (lines.size() > 1)
    return trouble(
        "the USB devices {0} and {1} have data; keep one: tshark -r FILE -Y 'usb.device_address == {2}' -w ONE.pcap",
        name_of_device(lines[0]), name_of_device(lines[1]), lines[0] & 0xFFFF);
  for (const std::uint32_t device : lines) {
    UsbAdapter& adapter = adapters_[device];
    notes_.push_back(
        adapter.has_status && adapter.kind.empty()
            ? fmt::format("USB device {}: an FTDI adapter, by the status before all that it sent", name_of_device(device))
        : adapter.kind.empty()
            ? fmt::format("USB device {}: the capture does not say which adapter it is; its data are taken as they are",
                          name_of_device(device))
            : fmt::format("USB device {}: {}", name_of_device(device), adapter.kind));
    add_frames(adapter, frames_);
  }
  if (short_ > 0) notes_.push_back(fmt::format("{} of the packets of serial lines end within their heads", short_));
  if (ends_early_ && !frames_.empty()) frames_.back().more_was_lost = true;
  if (recording.frames.empty()) {
    recording.frames = std::move(frames_);
  } else {
    std::ranges::move(frames_, std::back_inserter(recording.frames));
    std::ranges::stable_sort(recording.frames, {}, &RecordedFrame::at);
  }
  std::ranges::move(notes_, std::back_inserter(recording.notes));
  recording.is_log |= is_log_;
  return {};
}

}  // namespace s7200::tools
