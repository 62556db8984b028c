// Tells s7200.exe that its console was closed, in the way in which Windows itself does: by a thread in it.
#include <windows.h>

#include <cstdio>
#include <cwchar>
// After windows.h.
#include <tlhelp32.h>

int main() {
  const HANDLE all = CreateToolhelp32Snapshot(TH32CS_SNAPPROCESS, 0);
  PROCESSENTRY32W entry{};
  entry.dwSize = sizeof entry;
  int told = 0;
  for (BOOL more = Process32FirstW(all, &entry); more; more = Process32NextW(all, &entry)) {
    if (_wcsicmp(entry.szExeFile, L"s7200.exe") != 0) continue;
    const auto tell = reinterpret_cast<LPTHREAD_START_ROUTINE>(
        reinterpret_cast<void*>(GetProcAddress(GetModuleHandleW(L"kernelbase"), "CtrlRoutine")));
    const HANDLE process = OpenProcess(PROCESS_ALL_ACCESS, FALSE, entry.th32ProcessID);
    if (tell && process && CreateRemoteThread(process, nullptr, 0, tell, reinterpret_cast<void*>(CTRL_CLOSE_EVENT), 0, nullptr))
      ++told;
  }
  std::printf("%d\n", told);
  return told == 1 ? 0 : 1;
}
