// Holds a file as Excel does: nobody else may open it until standard input ends.
#include <windows.h>

#include <cstdio>

int main(int, char** words) {
  const HANDLE file = CreateFileA(words[1], GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_EXISTING, 0, nullptr);
  if (file == INVALID_HANDLE_VALUE) return 1;
  std::puts("held");
  std::fflush(stdout);
  std::getchar();
}
