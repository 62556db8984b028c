// hold FILE: holds a file as Excel does: nobody else may open it until standard input ends.
// hold FILE shared: has it open and lets others do with it what they like, as a console does that writes into it.
#include <windows.h>

#include <cstdio>

int main(int count, char** words) {
  const DWORD sharing = count > 2 ? FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE : 0;
  const HANDLE file = CreateFileA(words[1], GENERIC_READ | GENERIC_WRITE, sharing, nullptr, OPEN_EXISTING, 0, nullptr);
  if (file == INVALID_HANDLE_VALUE) return 1;
  std::puts("held");
  std::fflush(stdout);
  std::getchar();
}
