// This process as the system sees it, and other processes.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace s7200::tools {

/// The words of the command line in UTF-8, the name of the command first.
std::vector<std::string> words_of_command_line(int count, char** words);

/// The file of the command that runs, for starting it again.
std::string own_executable();

/// The processor time that this process has used: what else the machine does does not count.
std::chrono::nanoseconds processor_time();

/// A started process, whose output is read. The destructor waits for its end.
class StartedProcess {
 public:
  /// Throws std::runtime_error if it cannot be started.
  explicit StartedProcess(const std::vector<std::string>& words);
  ~StartedProcess();
  StartedProcess(const StartedProcess&) = delete;
  StartedProcess& operator=(const StartedProcess&) = delete;

  /// Waits for output. Returns false if the process ends without any.
  bool wait_for_output() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace s7200::tools
