#include "tools/rig/files/trace_files.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {

bool TraceFiles::claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind, Make make,
                       std::string& why) {
  if (path.empty()) return true;
  Record& record = records_.emplace_back();
  record.make = std::move(make);
  return record.file.claim(files, option, path, std::move(kind), why);
}

bool TraceFiles::open(FanOut& sinks, std::string& why) {
  for (Record& record : records_) {
    std::ostream* const out = record.file.open(why);
    if (!out) return false;
    record.sink = record.make(*out);
    sinks.add(record.sink.get());
  }
  return true;
}

bool TraceFiles::put(std::string& why) {
  return std::ranges::all_of(records_, [&](Record& record) { return record.file.put(why); });
}

void TraceFiles::flush() {
  for (Record& record : records_) record.file.flush();
}

void TraceFiles::add_sizes(std::vector<RecordSize>& sizes) const {
  for (const Record& record : records_)
    if (const auto size = record.file.size()) sizes.push_back(*size);
}

void TraceFiles::close(std::vector<std::string>& problems) {
  for (Record& record : records_) {
    std::string why;
    if (!record.file.close(why)) problems.push_back(why);
  }
}

}  // namespace s7200::tools
