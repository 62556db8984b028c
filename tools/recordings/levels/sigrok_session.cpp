// Sessions of sigrok, `.sr`: a zip with `metadata` and the samples of all channels.
// Source: sigrok.org, File format:Sigrok/v2.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels/levels.hpp"
#include "tools/recordings/levels/samplerate.hpp"
#include "tools/recordings/packets/zip.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

/// The first device in `metadata`.
struct Device {
  std::string capture_file{};
  std::uint64_t samplerate = 0;
  std::size_t unit_size = 1;
  std::map<std::size_t, std::string> probes{};  ///< by their numbers, from 1
};

Device device_of(std::string_view metadata) {
  constexpr std::size_t kMostUnits = 64, kMostProbes = 8 * kMostUnits;
  Device device;
  for (const std::string_view line : Lines(metadata)) {
    if (line == "[device 2]") break;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view key = stl::trim(line.substr(0, equals)), value = stl::trim(line.substr(equals + 1));
    constexpr std::string_view kProbe = "probe";
    if (key == "capturefile") device.capture_file = value;
    if (key == "samplerate") device.samplerate = samplerate_of(value).value_or(0);
    if (key == "unitsize")
      device.unit_size = std::clamp<std::size_t>(parse_decimal<std::size_t>(value).value_or(0), 1, kMostUnits);
    if (key.starts_with(kProbe))
      if (const auto number = parse_decimal<std::size_t>(key.substr(kProbe.size()));
          number && *number >= 1 && *number <= kMostProbes)
        device.probes[*number] = value;
  }
  return device;
}

/// Turns samples into edges.
class Sampler {
 public:
  Sampler(const Device& device, std::uint64_t samplerate) : unit_size_(device.unit_size), samplerate_(samplerate) {
    for (const auto& [number, name] : device.probes) {
      if (number > 8 * unit_size_) continue;
      bits_.push_back(number - 1);
      levels_.channels.push_back({.name = name});
    }
  }

  /// Takes samples. Returns false if they last longer than a recording can.
  bool take(std::string_view piece) {
    for (const char c : piece) {
      unit_ += c;
      if (unit_.size() < unit_size_) continue;
      if (unit_ != last_ && !set(unit_)) return false;
      unit_.clear();
      ++sample_;
    }
    return true;
  }

  Levels finish() {
    levels_.end = time_of(sample_).value_or(0);
    return std::move(levels_);
  }

 private:
  /// The time of a sample; nothing if it is further away than a recording can be.
  std::optional<Time> time_of(std::uint64_t sample) const {
    const long double seconds = static_cast<long double>(sample) / static_cast<long double>(samplerate_);
    return seconds < kFurthestTime / kSecond ? std::optional(static_cast<Time>(seconds * kSecond)) : std::nullopt;
  }

  bool set(const std::string& unit) {
    const auto at = time_of(sample_);
    if (!at) return false;
    for (std::size_t i = 0; i < bits_.size(); ++i)
      levels_.channels[i].set(*at, (static_cast<std::uint8_t>(unit[bits_[i] / 8]) >> bits_[i] % 8 & 1) != 0);
    last_ = unit;
    return true;
  }

  std::size_t unit_size_;
  std::uint64_t samplerate_, sample_ = 0;
  std::vector<std::size_t> bits_;  // of a unit, for each channel
  std::string unit_, last_;
  Levels levels_;
};

/// The files of the samples: `logic-1-1`, `logic-1-2` …, or `logic-1` in older sessions.
std::vector<std::string> files_of(const Zip& zip, const Device& device) {
  if (zip.has(device.capture_file)) return {device.capture_file};
  std::vector<std::string> files;
  for (std::size_t number = 1;; ++number) {
    std::string name = fmt::format("{}-{}", device.capture_file, number);
    if (!zip.has(name)) return files;
    files.push_back(std::move(name));
  }
}

/// The likely nature of a zip without sigrok's `metadata`.
std::string why_not_sigrok(const Zip& zip) {
  if (zip.has("meta.json")) return "a session of Saleae Logic 2; export its decoded table, or its raw data, as CSV";
  if (zip.has("header")) return "a session of DSView; export its decoder list as CSV, or its levels as CSV or VCD";
  return "a zip that is not a session of sigrok: unpack the recording";
}

/// Zip::read() with what it means that `take` wants no more.
Result<> read_of(const Zip& zip, std::string_view name, const std::function<bool(std::string_view piece)>& take,
                 std::string_view too_much) {
  const auto done = zip.read(name, take);
  return !done && done.why().empty() ? Trouble{std::string(too_much)} : done;
}

}  // namespace

bool looks_like_sigrok_session(std::string_view bytes) { return bytes.starts_with("PK\x03\x04"); }

Result<LineRecording> read_sigrok_session(std::string_view bytes, const ReadingChoices& choices) {
  const auto zip = Zip::open(bytes);
  if (!zip) return zip.trouble();
  if (!zip->has("metadata")) return Trouble{why_not_sigrok(*zip)};
  constexpr std::size_t kMostMetadata = std::size_t{1} << 20;
  std::string metadata;
  const auto keep = [&](std::string_view piece) { return metadata += piece, metadata.size() < kMostMetadata; };
  if (const auto done = read_of(*zip, "metadata", keep, "its metadata are too long"); !done) return done.trouble();
  const Device device = device_of(metadata);
  const auto files = files_of(*zip, device);
  const std::uint64_t samplerate = choices.samplerate != 0 ? choices.samplerate : device.samplerate;
  if (files.empty() || device.probes.empty()) return Trouble{"it has no levels; sigrok decodes analog channels"};
  if (samplerate == 0) return Trouble{"it does not say its samplerate: name it with --samplerate, as 1MHz"};
  Sampler sampler(device, samplerate);
  const auto take = [&](std::string_view piece) { return sampler.take(piece); };
  for (const std::string& file : files)
    if (const auto done = read_of(*zip, file, take, "it is longer than a recording can be"); !done) return done.trouble();
  return frames_of(sampler.finish(), choices);
}

}  // namespace s7200::tools
