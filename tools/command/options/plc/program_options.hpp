// What every verb with a PROGRAM has in common: where it is, for which CPU, with which times.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/model/times/times_band.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "tools/command/options/plc/plc_key_options.hpp"
#include "tools/views/program/times_text.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// --cpu, with one of the CPUs that are modelled; `text` says what it is for.
void add_cpu_option(CLI::App& app, std::string& cpu, const std::string& text);

/// For the text of --cpu where a program is run: which one is taken without it.
inline constexpr const char* kCpuFound = "[as its head or s7200.yaml says, or 214, 224, 226, 224XP: the first that can]";

/// For doubters.
inline constexpr const char* kNoSkip = "--no-skip";
void add_no_skip_option(CLI::App& app, bool& every_scan);

/// --repair, for slips of published listings.
void add_repair_option(CLI::App& app, Repairs& repairs);

/// Repairs what is asked for, with a note for each slip. False after a message if the text does not have one of them.
bool repair(SourceText& text, const Repairs& repairs);

struct CpuOptions {
  std::string cpu;          ///< empty: not named
  std::string times_table;  ///< a name or a file; empty: the CPU's own
  Repairs repairs;
  bool every_scan = false;    ///< scans that are all alike are run, too
  bool no_stand_ins = false;  ///< a program that needs a stand-in for a library is refused

  void add_to(CLI::App& app);

  /// --cpu and --times alone, for verbs that run nothing; `meaning` of the CPU, with the one that is taken without it.
  void add_cpu_and_times_to(CLI::App& app, const std::string& meaning);

  /// The model, a CPU 214 if none is named, and its times; nothing after a message. Ends in kUnusable. A model can have the
  /// system block that was asked for.
  const CpuModel* model() const;
  /// The same of the CPU to run a program of the file `path` on: if none is named, the one that is found for it.
  const CpuModel* model_for(const SourceText& text, const std::string& path) const;
  std::optional<TimeTable> times(const CpuModel& model) const;
  /// The table and others around it, in place of times(): a table from a pipe can be read once only.
  std::optional<TimesBand> band(const CpuModel& model, const BandSettings& settings) const;
  std::optional<SystemBlock> system_block(const CpuModel& model) const;

 private:
  PlcKeyOptions system_block_;
};

/// How that file of a program's project is named to verbs that take other words after the PROGRAM.
std::string how_to_give(const std::string& file);

struct ProgramOptions : CpuOptions {
  std::string path;
  std::vector<std::string> parts;  ///< more files of the same project: symbol tables, data blocks, blocks

  void add_to(CLI::App& app);

  /// The PROGRAM of a verb with no other words, all of which are files of the project.
  void add_files_to(CLI::App& app);

  /// --with, which names the parts.
  void add_parts_to(CLI::App& app);

  /// The checked program; warnings and errors are printed on stderr. Null when there are any errors: `exit_code` says which
  /// way to end.
  std::shared_ptr<const Program> load(int& exit_code) const;

  /// The same of a text that has been read.
  std::shared_ptr<const Program> load(SourceText text, int& exit_code) const;

  /// And for a CPU that has been found, with a table that has been read.
  std::shared_ptr<const Program> load(SourceText text, const CpuModel& model, const TimeTable& table, int& exit_code) const;
};

/// Tables of execution times, by their names or files; nothing after messages.
std::optional<std::vector<TitledTimes>> load_all(const std::vector<std::string>& tables, const CpuModel& model);

/// Reads a source as the verbs do, "-" from standard input, and that only once; nothing after a message.
std::optional<SourceText> read_program_text(const std::string& path, bool force_document = false);

/// The same of a program and its parts.
std::optional<SourceText> read_project(const std::string& path, const std::vector<std::string>& parts);

struct ProgramFiles {
  std::string path;  ///< of the program
  SourceText text;   ///< with its parts
};

/// The programs among the files; symbol tables and other parts of a project belong to all of them. Without a program the
/// parts are checked by themselves. What cannot be read makes `exit_code` kUnusable, after a message.
std::vector<ProgramFiles> read_programs(const std::vector<std::string>& paths, int& exit_code);

/// What is worth knowing of how a program was read: its notes, and which lines of the listing of a document were left out as
/// text.
std::vector<std::string> reading_notes(const SourceText& text);

/// Prints diagnostics on stderr, in colour where wanted: each cause once.
void print_diagnostics(const stl::Diagnostics& diagnostics, const stl::SourceLines& source);

}  // namespace s7200::tools
