// A molecule of the Protein Data Bank: atoms as spheres, bonds as cylinders, and the backbone of
// each chain as a tube. None of them is a mesh: they are drawn exactly, however near the camera is.
//
//   molecule FILE.pdb OUT.png
//
// The file: ATOM and HETATM of the first model (PDB format 3.3), columns as the format fixes them.
// Water is left out. Atoms are bonded that are nearer than their covalent radii and 0.4 Å.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

namespace {

using rastrum::Vec3, rastrum::Vec4;

struct Element {
  const char* name;
  float covalent, drawn;  ///< radii in Å
  Vec4 color;             ///< linear
};
constexpr Element kElements[] = {
    {"C", 0.76F, 0.42F, {0.09F, 0.09F, 0.10F, 1}},  {"N", 0.71F, 0.40F, {0.05F, 0.13F, 0.75F, 1}},
    {"O", 0.66F, 0.39F, {0.75F, 0.03F, 0.02F, 1}},  {"H", 0.31F, 0.25F, {0.80F, 0.80F, 0.80F, 1}},
    {"P", 1.07F, 0.50F, {0.90F, 0.25F, 0.01F, 1}},  {"S", 1.05F, 0.50F, {0.80F, 0.60F, 0.02F, 1}},
    {"ZN", 1.22F, 0.80F, {0.20F, 0.22F, 0.45F, 1}}, {"", 1.20F, 0.60F, {0.45F, 0.10F, 0.50F, 1}}};

struct Atom {
  Vec3 at;
  const Element* element;
  char chain;
  bool in_backbone;  ///< an amino acid's Cα, a nucleotide's P
};

/// Columns from `first`, counted from 1 as the format does, without blanks.
std::string columns(const std::string& line, std::size_t first, std::size_t last) {
  const std::string s = first <= line.size() ? line.substr(first - 1, last - first + 1) : "";
  const auto begin = s.find_first_not_of(" \r");
  return begin == std::string::npos ? "" : s.substr(begin, s.find_last_not_of(" \r") - begin + 1);
}

std::vector<Atom> read_atoms(const char* file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(std::string(file) + ": cannot be opened");
  std::vector<Atom> atoms;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line) && !line.starts_with("ENDMDL");) {
    ++number;
    const bool hetero = line.starts_with("HETATM");
    if (!hetero && !line.starts_with("ATOM  ")) continue;
    const std::string alternative = columns(line, 17, 17), residue = columns(line, 18, 20);
    if (residue == "HOH" || (!alternative.empty() && alternative != "A")) continue;
    const auto coordinate = [&](std::size_t first) {
      const std::string s = columns(line, first, first + 7);
      float value = 0;
      const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
      if (error != std::errc() || end != s.data() + s.size() || !std::isfinite(value))
        throw std::runtime_error(std::string(file) + ":" + std::to_string(number) +
                                 ": expected a coordinate in columns " + std::to_string(first) +
                                 " to " + std::to_string(first + 7));
      return value;
    };
    const std::string symbol = columns(line, 77, 78), name = columns(line, 13, 16);
    const Element* element = kElements;
    while (*element->name != 0 && symbol != element->name) ++element;
    atoms.push_back({{coordinate(31), coordinate(39), coordinate(47)},
                     element,
                     line[21],
                     !hetero && (name == "CA" || name == "P")});
  }
  if (atoms.empty()) throw std::runtime_error(std::string(file) + ": holds no atoms");
  return atoms;
}

/// Pairs of atoms, each once. Only neighbouring cells of 3 Å, more than any bond, are compared.
std::vector<std::pair<std::size_t, std::size_t>> bonds_of(const std::vector<Atom>& atoms) {
  using Cell = std::array<int, 3>;
  const auto cell_of = [](Vec3 p) {
    const auto cell = [](float x) { return static_cast<int>(std::floor(x / 3)); };
    return Cell{cell(p.x), cell(p.y), cell(p.z)};
  };
  std::map<Cell, std::vector<std::size_t>> cells;
  std::vector<std::pair<std::size_t, std::size_t>> bonds;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const Cell c = cell_of(atoms[i].at);
    for (int n = 0; n < 27; ++n) {
      const auto near = cells.find({c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1});
      if (near == cells.end()) continue;
      for (const std::size_t j : near->second)
        if (length(atoms[i].at - atoms[j].at) <
            atoms[i].element->covalent + atoms[j].element->covalent + 0.4F)
          bonds.emplace_back(j, i);
    }
    cells[c].push_back(i);
  }
  return bonds;
}

/// A curve through points (Catmull–Rom), six pieces from one to the next.
std::vector<Vec3> curve(const std::vector<Vec3>& p) {
  constexpr std::size_t kPieces = 6;
  std::vector<Vec3> r;
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t k = 0; k < kPieces; ++k) {
      const float t = static_cast<float>(k) / kPieces;
      const Vec3 before = p[i == 0 ? 0 : i - 1], after = p[std::min(i + 2, p.size() - 1)];
      r.push_back(p[i] + (p[i + 1] - before) * (0.5F * t) +
                  (before * 2 - p[i] * 5 + p[i + 1] * 4 - after) * (0.5F * t * t) +
                  (p[i] * 3 - before - p[i + 1] * 3 + after) * (0.5F * t * t * t));
    }
  r.push_back(p.back());
  return r;
}

/// Owns the arrays that the views below refer to.
struct Arrays {
  std::vector<Vec3> centers, ends, trace;
  std::vector<float> radii;
  std::vector<Vec4> center_colors, end_colors, trace_colors;
  std::vector<std::uint32_t> starts{0};  ///< of the polylines in `trace`
};

Arrays arrays_of(const std::vector<Atom>& atoms) {
  Arrays a;
  for (const Atom& atom : atoms) {
    a.centers.push_back(atom.at);
    a.radii.push_back(atom.element->drawn);
    a.center_colors.push_back(atom.element->color);
  }
  for (const auto& [i, j] : bonds_of(atoms)) {
    const Vec3 middle = (atoms[i].at + atoms[j].at) * 0.5F;
    for (const std::size_t k : {i, j}) {  // half of it in the colour of each
      a.ends.insert(a.ends.end(), {atoms[k].at, middle});
      a.end_colors.insert(a.end_colors.end(), 2, atoms[k].element->color);
    }
  }
  constexpr std::array<Vec4, 4> kChains = {{{0.02F, 0.35F, 0.40F, 1},
                                            {0.70F, 0.30F, 0.04F, 1},
                                            {0.25F, 0.45F, 0.05F, 1},
                                            {0.45F, 0.08F, 0.35F, 1}}};
  std::vector<Vec3> run;  // Cα or P that follow each other
  char chain = 0;
  const auto end_run = [&] {
    if (run.empty()) return;
    const std::vector<Vec3> points = curve(run);
    a.trace.insert(a.trace.end(), points.begin(), points.end());
    a.trace_colors.resize(a.trace.size(),
                          kChains[static_cast<unsigned char>(chain) % kChains.size()]);
    a.starts.push_back(static_cast<std::uint32_t>(a.trace.size()));
    run.clear();
  };
  for (const Atom& atom : atoms) {
    if (!atom.in_backbone) continue;
    // Where residues are missing the tube is, too.
    if (!run.empty() && (chain != atom.chain || length(run.back() - atom.at) > 8)) end_run();
    run.push_back(atom.at);
    chain = atom.chain;
  }
  end_run();
  return a;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: molecule FILE.pdb OUT.png");
  const std::vector<Atom> atoms = read_atoms(argv[1]);
  const Arrays a = arrays_of(atoms);
  const rastrum::SpheresView spheres{
      .centers = a.centers, .radii = a.radii, .colors = a.center_colors};
  const rastrum::CylindersView sticks{
      .positions = a.ends, .radius = 0.14F, .colors = a.end_colors, .caps = false};
  const rastrum::TubesView backbone{
      .positions = a.trace, .offsets = a.starts, .radius = 0.7F, .colors = a.trace_colors};
  const rastrum::Material shiny{.metallic = 0, .roughness = 0.45F};
  std::vector<rastrum::InstanceView> instances = {{spheres}, {sticks}};
  if (!a.trace.empty()) instances.push_back({backbone});
  const rastrum::SceneView scene{instances, {&shiny, 1}, {}};

  rastrum::FrameOptions frame;
  frame.width = 960;
  frame.height = 720;
  frame.samples = 8;
  frame.background = {1, 1, 1, 1};
  frame.shader = rastrum::Shader::material;
  rastrum::Camera along_z;
  along_z.fov_rad = 0.6F;
  const rastrum::Camera camera = rastrum::fit_picture(scene, along_z, frame.width, frame.height);
  rastrum::io::write_png(argv[2], rastrum::render(scene, camera, frame));
  std::printf("%zu atoms, %zu bonds: %s\n", atoms.size(), a.ends.size() / 4, argv[2]);
} catch (const std::exception& e) {
  std::fprintf(stderr, "molecule: %s\n", e.what());
  return 1;
}
