#include "tools/views/program/listing.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "tools/views/program/execution_text.hpp"

namespace s7200::tools::listing_test {
namespace {

std::shared_ptr<const Program> project() {
  std::vector<SourceText> files;
  for (const auto& [name, text] : {std::pair("main.awl",
                                             "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.1\nCALL Init\n"
                                             "END_ORGANIZATION_BLOCK\n"),
                                   std::pair("sub.awl",
                                             "// second\nSUBROUTINE_BLOCK Init:SBR0\nBEGIN\nNetwork 1\nLD SM0.0\n"
                                             "MOVB 1, VB0\nEND_SUBROUTINE_BLOCK\n")}) {
    files.push_back(read_source(text, name).value());
  }
  return check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214())).program;
}

std::uint32_t op_of(const Program& program, std::string_view mnemonic) {
  std::uint32_t op = 0;
  while (program.ops[op].instruction->mnemonic != mnemonic) ++op;
  return op;
}

TEST(Listing, EachLineHasItsNumberInItsOwnFile) {
  const auto program = project();
  ASSERT_TRUE(program);
  const Listing listing(*program);
  const auto shown = [&](std::string_view mnemonic) {
    return listing.around(listing.line_of(op_of(*program, mnemonic)), 0, 1, [](std::uint32_t) { return ">"; });
  };
  EXPECT_EQ(shown("CALL"), " >     5  CALL    0\n");
  EXPECT_EQ(shown("MOVB"), " > sub.awl:6  MOVB    1, VB0\n");
}

TEST(Listing, AnExecutedInstructionNamesItsFileToo) {
  const auto program = project();
  ASSERT_TRUE(program);
  EXPECT_TRUE(execution_text(InstructionRecord{.op = op_of(*program, "CALL")}, *program).starts_with("line 5     CALL "));
  EXPECT_TRUE(execution_text(InstructionRecord{.op = op_of(*program, "MOVB")}, *program).starts_with("sub.awl:6  MOVB "));
}

}  // namespace
}  // namespace s7200::tools::listing_test
