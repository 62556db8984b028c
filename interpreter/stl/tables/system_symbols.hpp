// The symbols that the programming software has by itself: the tables "S7-200 Symbols" of Micro/WIN 4, and "System Symbols"
// and "I/O Symbols" of Micro/WIN SMART. Exports print these names where such a table is part of the project, and nobody
// exports the table.
//
// Source: S7-200 SMART system manual A5E03822230-AF, appendix D, has the names for SMB0 to SMB7. Its p. 801 says that the
// names of a Micro/WIN 4 project mean the same there.
//
// Not documented, modelled so:
// - The addresses of these symbols, which follow from what their names say: Mode_Switch (SM0.7), Too_Many_D_IO and
//   Too_Many_A_IO (SM5.1 and SM5.2), EM0_ID to EM6_ID and EM0_Err to EM6_Err (SMB8 to SMB21), Last_Scan, Minimum_Scan and
//   Maximum_Scan (SMW22 to SMW26), Time_0_Intrvl and Time_1_Intrvl (SMB34 and SMB35).
//   [SystemSymbols.StandForTheSpecialMemoryThatTheirNamesSay]
// - The same of the ports, 0 and 1: P0_Config (SMB30), P0_Stat_Rcv, P0_Ctrl_Rcv, P0_Start_Char, P0_End_Char, P0_Idle_Time,
//   P0_Timeout and P0_Max_Char (SMB86 to SMB94). [SystemSymbols.OfPortsCountersAndPulseOutputsHaveTheirNumberInTheName]
// - The same of the high-speed counters, 0 to 5: HSC0_Status, HSC0_Ctrl, HSC0_CV and HSC0_PV (SMB36 to SMD42), and the
//   bits of the control byte: HSC0_Reset_Level, HSC0_Start_Level, HSC0_Rate, HSC0_Dir, HSC0_Dir_Update, HSC0_PV_Update,
//   HSC0_CV_Update and HSC0_Enable (SM37.0 to SM37.7).
//   [SystemSymbols.OfPortsCountersAndPulseOutputsHaveTheirNumberInTheName]
// - The same of the pulse outputs, 0 and 1: PTO0_Status, PLS0_Ctrl, PLS0_Cycle, PWM0_PW and PTO0_PC (SMB66 to SMD72),
//   PTO0_Seg_Num and PTO0_Profile_Offset (SMB166 and SMW168), the bits of the status byte PLS0_Err_Abort, PLS0_Cmd_Abort,
//   PLS0_Ovr and PLS0_Idle (SM66.4 to SM66.7), and those of the control byte PLS0_Cycle_Update, PWM0_PW_Update,
//   PTO0_PC_Update, PLS0_TimeBase, PWM0_Sync, PTO0_Op, PLS0_Select and PLS0_Enable (SM67.0 to SM67.7).
//   [SystemSymbols.OfPortsCountersAndPulseOutputsHaveTheirNumberInTheName]
// - P0_Config_3 is bit 3 of P0_Config; bits of P0_Stat_Rcv, P0_Ctrl_Rcv and HSC0_Status are named in the same way.
//   [SystemSymbols.ANumberAtTheEndIsABitOfTheByte]
// - CPU_Input9 is the tenth input of the CPU, I1.1, and CPU_Output9 its tenth output; CPU_输入9 and CPU_输出9 are the same
//   in Chinese. [SystemSymbols.CountTheInputsAndOutputsOfTheCpu]
#pragma once

#include <span>
#include <string_view>

#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

/// All system symbols. A name of the S7-200 SMART for which the S7-200 has nothing stands for no address.
std::span<const Symbol> system_symbols();

/// Whether it is one that Micro/WIN SMART has and Micro/WIN has not: `CPU_Input0`, `RTC_Lost`. In any capitals.
bool is_only_of_smart(std::string_view name);

}  // namespace s7200::stl
