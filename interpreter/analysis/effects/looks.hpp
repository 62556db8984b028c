// What a program looks at of the things that change by themselves.
#pragma once

#include <memory>

#include "interpreter/program/program.hpp"

namespace s7200 {

/// The same program, of which every scan is wanted: none is passed over.
std::shared_ptr<const Program> with_every_scan(const Program& program);

/// `program` is decoded. What a pointer reaches counts as looked at, and as written.
Looks looks_of(const Program& program);

}  // namespace s7200
