#include "tools/rig/files/trace_files.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {

Result<> TraceFiles::claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind, Make make) {
  if (path.empty()) return {};
  Record& record = records_.emplace_back();
  record.make = std::move(make);
  return record.file.claim(files, option, path, std::move(kind));
}

Result<> TraceFiles::open(FanOut& sinks) {
  for (Record& record : records_) {
    const auto out = record.file.open();
    if (!out) return out.trouble();
    record.sink = record.make(*out);
    sinks.add(record.sink.get());
  }
  return {};
}

Result<> TraceFiles::put() {
  return with_each(records_, [](Record& record) { return record.file.put(); });
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
    if (const auto done = record.file.close(); !done) problems.push_back(done.why());
  }
}

}  // namespace s7200::tools
