// generate_vectors FOLDER [--check]: writes the files of vectors from the reference model, or compares them with it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "interpreter/model/instruction.hpp"
#include "tests/vectors/cases.hpp"

namespace {

using namespace s7200;

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Empty if the reference model has nothing to say. Marks of expected failures stay as they are in `present`.
std::string generated(const Instruction& instruction, const CpuModel& model, const std::string& present) {
  vectors::File file;
  file.cpu = model.name;
  file.heading = {fmt::format("{}: {}", syntax(instruction), instruction.meaning),
                  "Generated from the reference model: change tests/vectors/*.cpp and run generate_vectors."};
  for (const vectors::Case& what : vectors::cases_of(instruction, model)) {
    try {
      file.vectors.push_back(vectors::execute(what, vectors::source_of(instruction), file.cpu));
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: {}", what.ops[0], error.what()));
    }
  }
  vectors::keep_marks(vectors::parse(present, "the file"), file);
  return file.vectors.empty() ? "" : vectors::to_text(file);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Writes the instruction vectors from the reference model"};
  std::filesystem::path folder;
  bool check = false;
  app.add_option("folder", folder, "tests/vectors")->required();
  app.add_flag("--check", check, "only compare the files with what would be written");
  CLI11_PARSE(app, argc, argv);

  int different = 0;
  for (const CpuModel* model : {&cpu214(), &cpu224()}) {
    for (const Instruction& instruction : all_instructions()) {
      if (!instruction.modelled() || !(instruction.cpus & model->self)) continue;
      const std::filesystem::path path = folder / (vectors::file_name(instruction.mnemonic, model->name) + ".txt");
      const std::string present = content_of(path), text = generated(instruction, *model, present);
      if (text.empty() || present == text) continue;
      ++different;
      fmt::print("{} {}\n", path.string(), check ? "is not what the reference model says" : "written");
      if (!check) std::ofstream(path, std::ios::binary) << text;
    }
  }
  return check && different != 0 ? 1 : 0;
}
