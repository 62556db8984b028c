#include "interpreter/stl/tables/symbols.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/symbol_table.hpp"

namespace s7200::stl::symbols_test {
namespace {

bool is_mnemonic(std::string_view word) { return word == "LD" || word == "="; }

/// `name=address comment` of each symbol.
std::vector<std::string> symbols(const std::string& text) {
  const ParseResult table = read_symbol_table(text, "t");
  EXPECT_TRUE(table.diagnostics.empty()) << render(table.diagnostics, table.source, false);
  std::vector<std::string> all;
  for (const Symbol& s : table.source.symbols)
    all.push_back(s.name + "=" + (s.value ? to_text({*s.value, {}}) : "") + (s.comment.empty() ? "" : " " + s.comment));
  return all;
}

SourceText file(const std::string& text, const std::string& name) {
  auto read = read_source(text, name);
  EXPECT_TRUE(read) << read.why();
  return *read;
}

/// What the check says of a program with a symbol table.
std::vector<std::string> said(const std::string& program, const std::string& table) {
  std::vector<SourceText> files{file(program, "p.awl")};
  if (!table.empty()) files.push_back(file(table, "t.txt"));
  const CheckResult result = check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214()));
  std::vector<std::string> lines;
  for (const Diagnostic& d : result.diagnostics) {
    const std::string text = render(d, result.source, false);
    lines.push_back(text.substr(0, text.find('\n')) + (d.hint.empty() ? "" : "; " + d.hint));
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(SymbolTable, IsReadFromTabsAndCommasWithAndWithoutHeadings) {
  EXPECT_EQ(symbols("Symbol\tAddress\tComment\nPump\tQ0.0\tcontactor\nLevel low\tI0.1\t\n"),
            (Lines{"Pump=Q0.0 contactor", "Level low=I0.1"}));
  EXPECT_EQ(symbols("Pump\tQ0.0\nSpeed\tVW100\tin rpm\n"), (Lines{"Pump=Q0.0", "Speed=VW100 in rpm"}));
  EXPECT_EQ(symbols("Name,Comment,Address\nPump,\"big, blue\",Q0.0\n"), Lines{"Pump=Q0.0 big, blue"});
  EXPECT_EQ(symbols("\"Pump \"\"1\"\"\",Q0.0,\"a, b\"\n"), Lines{"Pump \"1\"=Q0.0 a, b"});
  EXPECT_EQ(symbols("符号\t地址\t注释\n泵\tQ0.0\t\n"), Lines{"泵=Q0.0"});
}

TEST(SymbolTable, FindsNameAndAddressAmongOtherColumns) {
  EXPECT_EQ(symbols("1;Pump;Q0.0;contactor\n2;Fault;M0.0;\n"), (Lines{"Pump=Q0.0 contactor", "Fault=M0.0"}));
  EXPECT_EQ(symbols("Q0.0\tPump\tcontactor\n"), Lines{"Pump=Q0.0 contactor"});
}

TEST(SymbolTable, TakesConstantsGermanAddressesAndBlocks) {
  EXPECT_EQ(symbols("Baud\t16#49\nStart\tE0.0\nLamp\tA0.1\nMAIN\tOB1\nPrepare\tSBR0\n"),
            (Lines{"Baud=16#49", "Start=I0.0", "Lamp=Q0.1", "MAIN=OB1", "Prepare=SBR0"}));
}

TEST(SymbolTable, SeveralTablesMayFollowEachOther) {
  EXPECT_EQ(symbols("USER1\nSymbol\tAddress\nPump\tQ0.0\n\n// another\nUSER2\nAddress\tSymbol\nI0.0\tStart\n"),
            (Lines{"Pump=Q0.0", "Start=I0.0"}));
}

TEST(SymbolTable, SaysWhichAddressIsWrong) {
  const ParseResult table = read_symbol_table("Symbol\tAddress\nPump\tQ0.9\nLamp\tsomewhere\n", "t");
  ASSERT_EQ(table.diagnostics.size(), 2U);
  EXPECT_EQ(table.diagnostics[0].message, "the bits of a byte are 0 to 7");
  EXPECT_EQ(table.diagnostics[0].position, (Position{2, 6, 4}));
  EXPECT_EQ(table.diagnostics[1].message, "somewhere is not an address");
}

TEST(SymbolTable, IsToldFromListingsAndCharts) {
  EXPECT_TRUE(is_symbol_table("Pump\tQ0.0\nStart\tI0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("LD\tI0.0\n=\tQ0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("FROB 1, VB0\nFROB 1, VB0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("", is_mnemonic));
  EXPECT_TRUE(is_status_chart("Address\tFormat\tCurrent Value\nPump:Q0.0\tBit\t2#0\nVW10\tSigned\t+5\n"));
  EXPECT_FALSE(is_status_chart("LD\tI0.0\n=\tQ0.0\n"));
  EXPECT_EQ(file("Pump\tQ0.0\n", "t").kind, SourceKind::SymbolTable);
  EXPECT_EQ(file("VW0\tUnsigned\t1\nVW2\tSigned\t1\n", "t").kind, SourceKind::StatusChart);
}

TEST(SymbolTable, IsOneWhenItsHeadingsSaySoWhateverItsCellsHold) {
  for (const std::string table : {
           "Symbol\tAddress\tData type\tComment\nButton\tI0.0\tBOOL\tgreen\nLamp\tQ0.0\tBOOL\t\n",
           "Symbol\tAddress\tComment\nButton\tI0.0\treal\nLamp\tQ0.0\tsigned\n",
           "Rank\tSymbol\tAddress\tFormat\tRetentive\n1\tButton\tI0.0\tBit\tno\n2\tLamp\tQ0.0\tBit\tno\n",
           "Symbols of the press\n\nName;Data type;Logical address;Comment\nButton;Bool;%I0.0;x\nLamp;Bool;%Q0.0;y\n",
       }) {
    EXPECT_FALSE(is_status_chart(table)) << table;
    EXPECT_TRUE(is_symbol_table(table, is_mnemonic)) << table;
    EXPECT_EQ(said("LD Button\n= Lamp\nMEND\n", table), Lines{}) << table;
  }
}

TEST(SymbolTable, HasTypesBetweenNameAndAddressOrAfterThem) {
  EXPECT_EQ(symbols("Button\tBOOL\tI0.0\tgreen\nSpeed\tINT\tVW10\t\n"), (Lines{"Button=I0.0 green", "Speed=VW10"}));
  EXPECT_EQ(symbols("Button\tI0.0\tBOOL\tgreen\n"), Lines{"Button=I0.0 green"});
  EXPECT_EQ(symbols("Real\tVD4\nBit\tV0.0\n"), (Lines{"Real=VD4", "Bit=V0.0"}));
}

TEST(SymbolTable, ReadsAddressesWithAPercentSignOrAGap) {
  EXPECT_EQ(symbols("Button\t%I0.0\nLamp\t%QX0.1\nSpeed\t%VW10\nLevel\t%AIW4\n"),
            (Lines{"Button=I0.0", "Lamp=Q0.1", "Speed=VW10", "Level=AIW4"}));
  EXPECT_EQ(symbols("\"Button\",\"I      0.0\",\"BOOL\",\"green\"\n\"Count\",\"C 5\",\"\",\"\"\n"),
            (Lines{"Button=I0.0 green", "Count=C5"}));
}

TEST(SymbolTable, HeadingsMayBeInAnyLanguageOfMicroWinWithAndWithoutAccents) {
  for (const std::string headings :
       {"Mnémonique\tAdresse\tCommentaire", "MNÉMONIQUE\tADRESSE\tCOMMENTAIRE", "Nom\tOpérande\tType",
        "Symbole\tAdresse\tType de données", "Símbolo\tDirección\tComentario", "Simbolo\tIndirizzo\tCommento",
        "Symbol\tAdresse\tKommentar", "符号\t地址\t注释", "Name:\tOperand:\tremark", "Nome\tEndereço\tComentário"}) {
    const std::string table = headings + "\nButton\tI0.0\tREAL\n";
    EXPECT_TRUE(is_symbol_table(table, is_mnemonic)) << headings;
    const bool type = headings.find("Type") != std::string::npos;
    EXPECT_EQ(symbols(table), Lines{type ? "Button=I0.0" : "Button=I0.0 REAL"}) << headings;
  }
}

TEST(SymbolTable, OnlyTheColumnOfCommentsIsOne) {
  EXPECT_EQ(symbols("Symbol\tAddress\tData type\tComment\nButton\tI0.0\tBOOL\tgreen\nLamp\tQ0.0\tBOOL\t\n"),
            (Lines{"Button=I0.0 green", "Lamp=Q0.0"}));
  EXPECT_EQ(symbols("Rank;Symbol;Address;Comment;Retentive;Data type\n1;Button;I0.0;green;no;BOOL\n"),
            Lines{"Button=I0.0 green"});
  EXPECT_EQ(symbols("Name,Address,Retain\nButton,I0.0,True\n"), Lines{"Button=I0.0"}) << "no heading for comments";
  EXPECT_EQ(symbols("Name,Address\nButton,I0.0,green\n"), Lines{"Button=I0.0 green"}) << "a column without heading";
  EXPECT_EQ(symbols("Symbol,Address,Comment\nButton,I0.0,green, not red\n"), Lines{"Button=I0.0 green not red"});
  EXPECT_EQ(symbols("Symbol  Address  Type  Retain  Comment\nButton  I0.0  BOOL  no  big and green\n"),
            Lines{"Button=I0.0 big and green"});
  EXPECT_EQ(symbols("Button\tI0.0\tBOOL\tTrue\tgreen\n"), Lines{"Button=I0.0 green"}) << "no headings at all";
  EXPECT_EQ(symbols("Button   I0.0   // green\nLamp   Q0.0   // on\n"), (Lines{"Button=I0.0 green", "Lamp=Q0.0 on"}));
}

TEST(SymbolTable, MayBeAssignments) {
  for (const std::string table :
       {"Motor = Q0.0\nStart=I0.1 // green\n", "Motor: Q0.0\nStart: I0.1  // green\n", "Motor=Q 0.0;\nStart=%I0.1; green\n",
        "Motor -> Q0.0\nStart -> I0.1 green\n", "Motor AT Q0.0\nStart AT %I0.1 green\n"}) {
    EXPECT_EQ(file(table, "t").kind, SourceKind::SymbolTable) << table;
    EXPECT_EQ(symbols(table), (Lines{"Motor=Q0.0", "Start=I0.1 green"})) << table;
  }
  EXPECT_EQ(file("MOTOR = Q0.0\n", "t").kind, SourceKind::SymbolTable);
  EXPECT_EQ(symbols("Motor;Q0.0\nStart;I0.1\n"), (Lines{"Motor=Q0.0", "Start=I0.1"}));
}

TEST(SymbolTable, SettingsOfAnyKindAreNone) {
  EXPECT_FALSE(is_symbol_table("port: 502\nretries: 3\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("LD Motor\n= Q0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("LD I0.0 = Q0.0\nLD I0.1 = Q0.1\n", is_mnemonic)) << "two statements in a line";
  EXPECT_FALSE(is_symbol_table("LDW= VW0, 5\n= Q0.0\n", is_mnemonic));
}

TEST(SymbolTable, MayHaveOnlyBlanksOrBarsBetweenItsColumns) {
  for (const std::string table : {
           "Symbol     Address   Comment\nPump 1     Q0.0      big, blue\nStart      I0.1\n",
           "Symbol Address Data type Comment\n\"Pump 1\" Q0.0 BOOL big\nStart I0.1 BOOL x\n",
           "Address  Symbol\nQ0.0  \"Pump 1\"  blue\nI 0.1  Start\n",
           "| Symbol | Address | Comment |\n|---|---|---|\n| Pump 1 | Q0.0 | blue |\n| Start | I0.1 | |\n",
           "Pump 1   Q0.0   blue\nStart    I0.1   green\n",
       }) {
    EXPECT_TRUE(is_symbol_table(table, is_mnemonic)) << table;
    EXPECT_EQ(said("LD Start\n= \"Pump 1\"\nMEND\n", table), Lines{}) << table;
  }
  EXPECT_EQ(symbols("Symbol Address\nBaud 16#49\nLimit 100\n"), (Lines{"Baud=16#49", "Limit=100"}));
}

TEST(SymbolTable, RowsWithBlanksAloneAreNoTableInAListingOrInOtherText) {
  EXPECT_FALSE(is_symbol_table("LD I0.0\n= Q0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("FROB I0.0\nFRIB Q0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("Port 22\nTimeout 30\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("The pump is at Q0.0 and\nstarts when the button is pressed,\nwhich is wired to the CPU.\n",
                               is_mnemonic));
  EXPECT_FALSE(is_status_chart("a real value\na bit\n"));
}

TEST(SymbolTable, AnAddressThatIsWrongIsNamedInARowWithBlanksToo) {
  const ParseResult table = read_symbol_table("Symbol Address\nPump Q0.9\nLamp Q0.0\n", "t");
  ASSERT_EQ(table.diagnostics.size(), 1U);
  EXPECT_EQ(table.diagnostics[0].message, "the bits of a byte are 0 to 7");
  EXPECT_EQ(table.diagnostics[0].position, (Position{2, 6, 4}));
}

TEST(SymbolTable, ACommaInACommentMakesNoStatusChartOfIt) {
  for (const std::string table : {"Symbol\tAddress\tComment\nButton\tI0.0\tgreen, real\nLamp\tQ0.0\t\n",
                                  "Button\tI0.0\tgreen, real\nLamp\tQ0.0\tred, hex\n",
                                  "Symbol  Address  Comment\nButton  E0.0  Taster, hex\nLamp    A0.0  rot\n"}) {
    EXPECT_FALSE(is_status_chart(table)) << table;
    EXPECT_EQ(file(table, "t").kind, SourceKind::SymbolTable) << table;
  }
}

TEST(SymbolTable, ARowTypedWithBlanksIsRead) {
  EXPECT_EQ(symbols("Symbol\tAddress\nButton\tI0.0\nLamp Q0.0 red\nPage 2\nPump\tQ0.1\n"),
            (Lines{"Button=I0.0", "Lamp=Q0.0 red", "Pump=Q0.1"}));
  EXPECT_EQ(said("LD SM0.0\nMOVW Speed, VW2\nMEND\n", "Symbol\tAddress\nSpeed\tVW100\n\nSpeed 7\n"),
            Lines{"t.txt:4:1: error: Speed is defined twice; it is first defined in line 2"});
}

TEST(SymbolTable, AnAddressThatCannotBeIsSaidOnce) {
  const std::string row = "a row of a symbol table is a name, an address or a constant, and perhaps a comment";
  EXPECT_EQ(said("LD Button\n= Q0.0\nMEND\n", "Symbol\tAddress\nButton\tI0.9\n"),
            Lines{"t.txt:2:8: error: the bits of a byte are 0 to 7; " + row});
  EXPECT_EQ(said("LD I0.0\n= Pump\nMEND\n", "Symbol\tAddress\nButton\tI0.0\nPump Q0.9 blue\n"),
            Lines{"t.txt:3:6: error: the bits of a byte are 0 to 7; " + row});
}

TEST(SymbolTable, HasDeclarationsWithTheirAddresses) {
  EXPECT_EQ(file("Button AT %I0.0 : BOOL;\nLamp AT %Q0.0 : BOOL;\n", "t").kind, SourceKind::SymbolTable);
}

TEST(StatusChart, HasFormatsAndValuesAndNoColumnOfSymbols) {
  for (const std::string chart : {
           "Address\tFormat\tCurrent Value\tNew Value\n",
           "Adresse\tFormat\tValeur actuelle\tNouvelle valeur\nVW0\tSigné\t+5\t\n",
           "地址\t格式\t当前值\t新值\nI0.0\t位\t2#0\t\n",
           "VW0\tUnsigned\t1\nPump\tBit\t2#1\n",
           "VW0   Signed   +5\nVB4   Hexadecimal   16#00\n",
       }) {
    EXPECT_TRUE(is_status_chart(chart)) << chart;
    EXPECT_EQ(file(chart, "t").kind, SourceKind::StatusChart) << chart;
  }
}

TEST(Project, AFileOfWhichNothingIsUsedIsNamed) {
  std::vector<SourceText> files{file("LD I0.0\n= Q0.0\nMEND\n", "p.awl"), file("VW0\tSigned\t+5\n", "chart.txt"),
                                file("// nothing yet\n", "data.awl"), file("Symbol\tAddress\n", "symbols.txt")};
  EXPECT_EQ(join_files(std::move(files)).parsed.notes,
            (Lines{"chart.txt is a status chart: nothing of it is part of the program",
                   "nothing in data.awl is part of the program", "nothing in symbols.txt is part of the program"}));
  EXPECT_EQ(join_files({file("VW0\tSigned\t+5\n", "chart.txt")}).parsed.notes.size(), 1U);
}

/// The addresses of names, with blanks between them.
std::string addresses(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    const Symbol* symbol = find_symbol({}, name);
    text += (text.empty() ? "" : " ") + (symbol && symbol->value ? to_text({*symbol->value, {}}) : "?");
  }
  return text;
}

TEST(SystemSymbols, StandForTheSpecialMemoryThatTheirNamesSay) {
  EXPECT_EQ(addresses({"Always_On", "First_Scan_On", "Retentive_Lost", "RUN_Power_Up", "Clock_60s", "Clock_1s", "Clock_Scan",
                       "Mode_Switch"}),
            "SM0.0 SM0.1 SM0.2 SM0.3 SM0.4 SM0.5 SM0.6 SM0.7");
  EXPECT_EQ(addresses({"Result_0", "Overflow_Illegal", "Neg_Result", "Divide_By_0", "Table_Overflow", "Table_Empty",
                       "Not_BCD", "Not_Hex"}),
            "SM1.0 SM1.1 SM1.2 SM1.3 SM1.4 SM1.5 SM1.6 SM1.7");
  EXPECT_EQ(addresses({"Receive_Char", "Parity_Err", "Comm_Int_Ovr", "RUN_Err", "Int_Enable", "Xmit0_Idle", "Force_On",
                       "IO_Err", "Too_Many_D_IO", "CPU_ID", "EM2_Err", "Last_Scan", "Maximum_Scan", "Time_1_Intrvl"}),
            "SMB2 SM3.0 SM4.0 SM4.3 SM4.4 SM4.5 SM4.7 SM5.0 SM5.1 SMB6 SMB13 SMW22 SMW26 SMB35");
  EXPECT_EQ(said("LD first_scan_on\nMOVB 100, \"Time_0_Intrvl\"\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nMOVB "
                 "Receive_Char, VB0\nRETI\n",
                 ""),
            Lines{});
}

TEST(SystemSymbols, OfPortsCountersAndPulseOutputsHaveTheirNumberInTheName) {
  EXPECT_EQ(addresses({"P0_Config", "P1_Config", "P0_Stat_Rcv", "P1_Ctrl_Rcv", "P0_Start_Char", "P1_End_Char",
                       "P0_Idle_Time", "P0_Timeout", "P1_Max_Char", "P2_Config"}),
            "SMB30 SMB130 SMB86 SMB187 SMB88 SMB189 SMW90 SMW92 SMB194 ?");
  EXPECT_EQ(addresses({"HSC0_Status", "HSC1_Ctrl", "HSC2_CV", "HSC3_PV", "HSC4_Dir", "HSC5_Enable", "HSC6_CV"}),
            "SMB36 SMB47 SMD58 SMD142 SM147.3 SM157.7 ?");
  EXPECT_EQ(addresses({"PLS0_Ctrl", "PLS1_Cycle", "PWM0_PW", "PTO1_PC", "PTO0_Status", "PLS1_Idle", "PLS0_Enable",
                       "PTO1_Seg_Num", "PTO0_Profile_Offset"}),
            "SMB67 SMW78 SMW70 SMD82 SMB66 SM76.7 SM67.7 SMB176 SMW168");
}

TEST(SystemSymbols, ANumberAtTheEndIsABitOfTheByte) {
  EXPECT_EQ(addresses({"P0_Config_0", "P1_Ctrl_Rcv_7", "P0_Stat_Rcv_5", "HSC0_Status_6", "P0_Config_8", "P0_Max_Char_0"}),
            "SM30.0 SM187.7 SM86.5 SM36.6 ? ?");
}

TEST(SystemSymbols, CountTheInputsAndOutputsOfTheCpu) {
  EXPECT_EQ(addresses({"CPU_Input0", "CPU_Input9", "CPU_Output15", "CPU_输入0", "CPU_输出8"}), "I0.0 I1.1 Q1.7 I0.0 Q1.0");
}

TEST(SystemSymbols, NeverWinAgainstTheUsersNames) {
  EXPECT_EQ(said("LD Always_On\n= Q0.0\nMEND\n", "Always_On\tI0.0\n"), Lines{});
  EXPECT_EQ(said("LD Always_On\n= Q0.0\nMEND\n", "Symbol\tAddress\tComment\nAlways_On\t\tto do\n"),
            Lines{"p.awl:1:4: error: symbol Always_On has no address"});
  ParseResult parsed = file("LD Always_On\n= Clock_1s:M0.0\nMEND\n", "p.awl").parsed;
  parsed.source.symbols.push_back({"ALWAYS_ON", Address{"I", Size::Bit, 0, 0}, {}, {}});
  resolve_symbols(parsed);
  EXPECT_TRUE(parsed.diagnostics.empty());
  EXPECT_EQ(std::get<Statement>(parsed.source.lines[0]).operands[0].value, (OperandValue{Address{"I", Size::Bit, 0, 0}}));
}

TEST(SystemSymbols, ThatOnlyTheSmartHasAreNamed) {
  EXPECT_EQ(said("LD RTC_Lost\n= Q0.0\nMEND\n", ""),
            Lines{"p.awl:1:4: error: RTC_Lost is a symbol of the S7-200 SMART; the S7-200 has nothing for it"});
}

TEST(SystemSymbols, ThatOnlyTheSmartHasAreSaidOnce) {
  const auto notes = [](const std::string& program, const std::string& table) {
    std::vector<SourceText> files{file(program, "p.awl")};
    if (!table.empty()) files.push_back(file(table, "t.txt"));
    return join_files(std::move(files)).parsed.notes;
  };
  const Lines said{
      "p.awl: CPU_Input0 is a symbol of the S7-200 SMART; a program for the SMART runs here as CPU 226 as far as it "
      "goes"};
  EXPECT_EQ(notes("LD CPU_Input0\n= CPU_Output0\nLD Always_On\n= Q0.1\n", ""), said);
  EXPECT_EQ(notes("LD \"CPU_Input0\"\n= Q0.0\n", ""), said);
  EXPECT_EQ(notes("LD CPU_Input0\n= Q0.0\n", "CPU_Input0\tI0.0\n"), Lines{}) << "the user's own";
  EXPECT_EQ(notes("LD Always_On\n= Q0.0\n", ""), Lines{}) << "both have it";
}

TEST(Symbols, OneThatIsMisspeltIsNamed) {
  EXPECT_EQ(said("LD Strat\n= Motor1\nMEND\n", "Start\tI0.0\nMotor\tQ0.0\n"),
            (Lines{"p.awl:1:4: error: 'Strat' is neither an address nor a defined symbol; did you mean Start?",
                   "p.awl:2:3: error: 'Motor1' is neither an address nor a defined symbol; did you mean Motor?"}));
  EXPECT_EQ(said("LD AlwaysOn\n= Q0.0\nMEND\n", ""),
            Lines{"p.awl:1:4: error: 'AlwaysOn' is neither an address nor a defined symbol; did you mean Always_On?"});
  EXPECT_EQ(said("LD First_Scan\n= Q0.0\nMEND\n", ""),
            Lines{"p.awl:1:4: error: 'First_Scan' is neither an address nor a defined symbol; did you mean First_Scan_On?"});
  EXPECT_EQ(
      said("LD Button\n= Q0.0\nMEND\n", "Motor\tQ0.0\n"),
      Lines{"p.awl:1:4: error: 'Button' is neither an address nor a defined symbol; t.txt does not have it; add it there, "
            "or write the address itself"});
}

TEST(Symbols, OneThatTheTableDoesNotHaveIsSaidWithThoseThatAreLikeIt) {
  EXPECT_EQ(
      said("LD PumpRun\n= Q0.0\nMEND\n", "Start\tI0.0\nRun_Pump\tI0.1\nPump_1\tQ0.0\n"),
      Lines{"p.awl:1:4: error: 'PumpRun' is neither an address nor a defined symbol; t.txt does not have it; the nearest "
            "are Run_Pump, Pump_1; add it there, or write the address itself"});
}

TEST(Symbols, StandForAddressesConstantsAndPointers) {
  EXPECT_EQ(said("LD Start\nMOVW Limit, Speed\nMOVD &Table, Next\nMOVB *Next, \"First one\"\nMEND\n",
                 "Start\tI0.0\nLimit\t100\nSpeed\tVW10\nTable\tVB100\nNext\tVD20\nFirst one\tVB30\n"),
            Lines{});
}

TEST(Symbols, OneWrittenInOtherCapitalsIsFoundIfItIsTheOnlyOne) {
  EXPECT_EQ(said("LD START\n= Q0.0\nMEND\n", "Start\tI0.0\n"), Lines{});
  EXPECT_EQ(said("LD start\nLD Start\nLD START\nALD\nALD\n= Q0.0\nMEND\n", "Start\tI0.0\nSTART\tI0.1\n"),
            Lines{"p.awl:1:4: error: 'start' is neither an address nor a defined symbol; did you mean Start?"});
}

TEST(Symbols, DefinedTwiceAreReportedAtTheSecondPlace) {
  EXPECT_EQ(said("LD Start\n= Q0.0\nMEND\n", "Start\tI0.0\nStop\tI0.1\nStart\tI0.2\n"),
            Lines{"t.txt:3:1: error: Start is defined twice; it is first defined in line 1"});
}

TEST(Symbols, WithoutAnAddressAreReportedOnlyWhereTheyAreUsed) {
  EXPECT_EQ(said("LD Start\n= Q0.0\nMEND\n", "Symbol\tAddress\tComment\nStart\t\tto do\nStop\t\tto do\n"),
            Lines{"p.awl:1:4: error: symbol Start has no address"});
}

TEST(Symbols, UndefinedOnesShareACauseOnlyWithoutATable) {
  const auto causes = [](const std::string& table) {
    std::vector<SourceText> files{file("LD P1\nA P2\n= Q0.0\nMEND\n", "p")};
    if (!table.empty()) files.push_back(file(table, "t"));
    return count_causes(check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214())).diagnostics);
  };
  EXPECT_EQ(causes(""), 1U);
  EXPECT_EQ(causes("Other\tI0.0\n"), 2U);
}

TEST(Symbols, NameBlocksInCallAndAtch) {
  EXPECT_EQ(
      said("LD SM0.0\nCALL Prepare\nATCH Edge, 0\nENI\nMEND\nSBR 4\nRET\nINT 2\nRETI\n", "Prepare\tSBR4\nEdge\tINT2\n"),
      Lines{});
  EXPECT_EQ(said("LD SM0.0\nCALL Edge\nMEND\nINT 2\nRETI\n", "Edge\tINT2\n").at(0).substr(0, 53),
            "p.awl:2:6: error: Edge is not a subroutine; subroutin");
}

TEST(Symbols, TablesTakeTimeInProportionToTheirSize) {
  std::string wide(1'000'000, ',');
  EXPECT_TRUE(read_symbol_table(wide, "t").source.symbols.empty());
  EXPECT_TRUE(read_symbol_table(std::string(1'000'000, '"'), "t").source.symbols.empty());
  std::string long_table = "Symbol,Address\n";
  for (int i = 0; i < 50'000; ++i) long_table += "S" + std::to_string(i) + ",VB" + std::to_string(i) + "\n";
  EXPECT_EQ(read_symbol_table(long_table, "t").source.symbols.size(), 50'000U);
}

TEST(Symbols, ANameThatIsAnAddressOrAConstantIsRefused) {
  for (const std::string name : {"VW5", "16#4", "T37"}) {
    const ParseResult table = read_symbol_table("Symbol\tAddress\n" + name + "\tI0.0\n", "t");
    ASSERT_EQ(table.diagnostics.size(), 1U) << name;
    EXPECT_EQ(table.diagnostics[0].message, name + " is an address or a constant, not a name");
  }
}

TEST(Symbols, NamesThatAreOnlyTheBeginningOfAnAddressStandForTheirSymbols) {
  const std::string table = "S1\tI0.1\nK1\tQ0.0\nE1\tI0.2\n";
  EXPECT_EQ(said("LD S1\nA E1\n= K1\nMEND\n", table), Lines{});
  EXPECT_EQ(said("LD S2\nMEND\n", table).size(), 1U);
}

TEST(Symbols, EmptyColumnsMayStandLeftOfTheRowsAlone) {
  EXPECT_EQ(symbols("Symbol\tAddress\tComment\n\t\tStart\tI0.0\tgreen\n\tStop\tI0.1\n"),
            (std::vector<std::string>{"Start=I0.0 green", "Stop=I0.1"}));
}

TEST(Symbols, AnAddressBesideANameMustBeTheOneItStandsFor) {
  EXPECT_EQ(said("LD Pump:Q0.1\nMEND\n", "Pump\tQ0.0\n"),
            Lines{"p.awl:1:4: error: Pump is Q0.1 here; it is Q0.0 in t.txt:1"});
  EXPECT_EQ(said("LD Pump:Q0.1\nA Pump:Q0.1\n= Pump:Q0.0\nMEND\n", ""),
            Lines{"p.awl:3:3: error: Pump is Q0.0 here; it is Q0.1 in line 1"});
  EXPECT_EQ(said("LD Pump:Q0.0\nMOVD &Speed:VB4, VD0\nMOVD Speed:VB4, VD0\nMEND\n", "Pump\tQ0.0\nSpeed\tVB4\n").size(), 1U);
}

TEST(Symbols, GermanLettersMayBeNamesInAnInternationalProgram) {
  EXPECT_EQ(said("LD Z1\nMOVW AW1, VW0\nMEND\n", "Z1\tI0.1\nAW1\tVW4\n"), Lines{});
  EXPECT_EQ(said("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL E1\nEND_ORGANIZATION_BLOCK\n"
                 "SUBROUTINE_BLOCK E1:SBR0\nBEGIN\nNETWORK 1\nLD SM0.0\n= M0.0\nEND_SUBROUTINE_BLOCK\n",
                 ""),
            Lines{});
}

TEST(Symbols, BlocksAndVariablesMayHaveNamesThatAreOnlyTheBeginningOfAnAddress) {
  const std::string program =
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL K1\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK One:SBR1\nBEGIN\nNETWORK 1\nEND_SUBROUTINE_BLOCK\n"
      "SUBROUTINE_BLOCK K1:SBR3\nVAR\n K7 : WORD;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW K7, VW0\n"
      "END_SUBROUTINE_BLOCK\n";
  ParseResult parsed = file(program, "p.awl").parsed;
  resolve_symbols(parsed);
  std::vector<std::string> operands;
  for (const Line& line : parsed.source.lines)
    if (const auto* statement = std::get_if<Statement>(&line))
      for (Operand operand : statement->operands) operands.push_back((operand.symbol.clear(), to_text(operand)));
  EXPECT_EQ(operands, (Lines{"SM0.0", "3", "1", "3", "SM0.0", "LW0", "VW0"}));
}

TEST(Symbols, NamesThatBeginLikeAnAddressMayHaveTheirAddressBesideThem) {
  EXPECT_EQ(said("LD S1:I0.0\nA E1:I0.1\n= K1:Q0.1\nMOVW AW1:VW10, VW0\nCTU Z1:C1, 5\nMEND\n",
                 "S1\tI0.0\nE1\tI0.1\nK1\tQ0.1\nAW1\tVW10\nZ1\tC1\n")
                .size(),
            1U);  // CTU lacks its second LD
}

}  // namespace
}  // namespace s7200::stl::symbols_test
