#include "tools/coverage/coverage.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {
namespace {

std::vector<ContactForm> forms_of(const Program& program) {
  std::vector<ContactForm> forms;
  for (const Op& op : program.ops) forms.push_back(contact_form(*op.instruction));
  return forms;
}

void add_marks(std::vector<std::uint8_t>& to, const std::vector<std::uint8_t>& from) {
  std::ranges::transform(to, from, to.begin(), [](std::uint8_t a, std::uint8_t b) { return std::uint8_t(a | b); });
}

}  // namespace

CoverageMap::CoverageMap(std::shared_ptr<const Program> program)
    : program_(std::move(program)),
      forms_(forms_of(*program_)),
      decisions_(tools::decisions_of(*program_, forms_)),
      decisions_of_(program_->ops.size()) {
  std::uint32_t decision = 0;
  for (std::uint32_t op = 0; op < program_->ops.size(); ++op) {
    first_.push_back(decision);
    while (decision < decisions_.all.size() && decisions_.all[decision].op == op) ++decision;
    const ContactForm& form = forms_[op];
    constant_.push_back(!form.is_contact()              ? ""
                        : decisions_.constant_input[op] ? "what reaches it never changes"
                                                        : tools::why_constant(program_->ops[op], form));
  }
  first_.push_back(decision);
  for (std::uint32_t number = 0; number < decisions_.all.size(); ++number)
    for (const std::uint32_t op : decisions_.all[number].contacts) decisions_of_[op].push_back(number);
}

bool CoverageMap::is_instruction(std::uint32_t op) const {
  const Structure structure = program_->ops[op].instruction->structure;
  return !begins_routine(structure) && structure != Structure::Label;
}

Tried::Tried(const CoverageMap& map) : marks(map.program().ops.size()) {
  for (const Decision& decision : map.decisions()) alone.emplace_back(decision.contacts.size());
}

void Tried::add(const Tried& other) {
  add_marks(marks, other.marks);
  for (std::size_t i = 0; i < alone.size(); ++i) add_marks(alone[i], other.alone[i]);
}

std::vector<bool> Tried::deciding(const CoverageMap& map) const {
  std::vector<bool> found(marks.size());
  for (std::size_t i = 0; i < alone.size(); ++i)
    for (std::size_t contact = 0; contact < alone[i].size(); ++contact)
      if (has_decided(alone[i][contact])) found[map.decisions()[i].contacts[contact]] = true;
  return found;
}

CoverageSink::CoverageSink(std::shared_ptr<const CoverageMap> map)
    : map_(std::move(map)), tried_(*map_), known_(map_->decisions().size()) {}

void CoverageSink::begin(const Cpu& cpu) {
  cpu_ = &cpu;
  level_ = 0;
  seen_.assign(map_->program().ops.size(), {});
  for (Known& known : known_) known.changed = true;
}

void CoverageSink::record(const TraceRecord& record) {
  if (record.kind == TraceKind::ServiceBegin || record.kind == TraceKind::ScanBegin) level_ = level_now();
  if (record.kind == TraceKind::ModeChange) remember_edges();
}

/// The memory bits of EU and ED, as a power-up or what was before has left them.
void CoverageSink::remember_edges() {
  for (std::uint32_t op = 0; op < seen_.size(); ++op)
    if (map_->form(op).is_edge()) seen_[op].now = edge_memory(op);
}

bool CoverageSink::edge_memory(std::uint32_t op) const {
  const Operand& memory = map_->program().ops[op][2];
  return (cpu_->state().image[memory.at] >> memory.bit) & 1;
}

/// An interrupt, or a call, may come between the contacts of a condition and its output, and execute the same contacts.
std::uint8_t CoverageSink::level_now() const {
  const State& state = cpu_->state();
  return static_cast<std::uint8_t>(state.call_depth | (state.in_interrupt ? 0x40 : 0));
}

void CoverageSink::instruction(const InstructionRecord& record) {
  tried_.marks[record.op] |= record.powered ? Tried::kExecuted : Tried::kSkipped;
  if (const ContactForm& form = map_->form(record.op); form.is_contact()) return see(form, record);
  const auto [first, end] = map_->decisions_at(record.op);
  for (std::uint32_t decision = first; decision < end; ++decision)
    if (known_[decision].changed || known_[decision].level != level_) decide(decision);
  level_ = level_now();
}

void CoverageSink::see(const ContactForm& form, const InstructionRecord& record) {
  const Op& op = map_->program().ops[record.op];
  const bool step_is_off = op.in_segment && !cpu_->state().rail;  // then no contact of it lets anything through
  std::optional<bool> closed;
  if (!step_is_off)
    closed = form.kind == ContactForm::Kind::Bit ? (record.value[0].value_or(0) != 0) != form.inverted
                                                 : lets_through(*cpu_, op, form, record);
  LastSeen seen = seen_[record.op];
  seen.level = closed ? level_ : kNever;
  if (closed) {
    tried_.marks[record.op] |= *closed ? Tried::kClosed : Tried::kOpen;
    seen.closed = *closed;
  }
  if (form.is_edge()) {
    seen.before = seen.now;
    seen.now = edge_memory(record.op);
  }
  if (seen == seen_[record.op]) return;
  seen_[record.op] = seen;
  for (const std::uint32_t decision : map_->decisions_of(record.op)) known_[decision].changed = true;
}

bool CoverageSink::is_known(Known& known, std::uint64_t key) {
  if (known.keys.contains(key)) return true;
  if (known.keys.size() < kMostKept) known.keys.insert(key);
  return false;
}

/// Worked out anew only after something of it has changed: as often as not nothing has.
void CoverageSink::decide(std::uint32_t number) {
  const Decision& decision = map_->decisions()[number];
  Known& known = known_[number];
  known.changed = false;
  known.level = level_;
  const std::size_t contacts = decision.contacts.size();
  std::uint64_t key = 0;
  for (const std::uint32_t op : decision.contacts) {
    const LastSeen& seen = seen_[op];
    if (seen.level != level_) return;
    key = key << 2 | (seen.closed ? 2 : 0) | (seen.before ? 1 : 0);
  }
  if (2 * contacts <= kKeyBits && is_known(known, key)) return;
  now_.closed.resize(contacts);
  now_.before.resize(contacts);
  for (std::size_t i = 0; i < contacts; ++i) {
    now_.closed[i] = seen_[decision.contacts[i]].closed;
    now_.before[i] = seen_[decision.contacts[i]].before;
  }
  find_deciding(decision, now_, tried_.alone[number]);
}

}  // namespace s7200::tools
