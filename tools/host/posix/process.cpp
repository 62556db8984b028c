#include "tools/host/process.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace s7200::tools {

std::vector<std::string> words_of_command_line(int count, char** words) { return {words, words + count}; }

/// A package that brings its own loader has a script that starts it; /proc/self/exe is the loader then.
std::string own_executable() {
  const char* const script = std::getenv("S7200_STARTED_BY");
  return script ? script : "/proc/self/exe";
}

std::chrono::nanoseconds processor_time() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return std::chrono::seconds(used.tv_sec) + std::chrono::nanoseconds(used.tv_nsec);
}

struct StartedProcess::Handles {
  int out = -1;
  pid_t process = 0;
};

StartedProcess::StartedProcess(const std::vector<std::string>& words) : handles_(std::make_unique<Handles>()) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  handles_->out = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  std::vector<std::string> own = words;
  std::vector<char*> arguments;
  for (std::string& word : own) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int error = posix_spawn(&handles_->process, own[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (error == 0) return;
  ::close(handles_->out);
  throw std::system_error(error, std::generic_category(), own[0]);
}

StartedProcess::~StartedProcess() {
  ::close(handles_->out);
  while (waitpid(handles_->process, nullptr, 0) < 0 && errno == EINTR) continue;
}

bool StartedProcess::wait_for_output() const {
  char first = 0;
  ssize_t count = 0;
  while ((count = read(handles_->out, &first, 1)) < 0 && errno == EINTR) continue;
  return count > 0;
}

}  // namespace s7200::tools
