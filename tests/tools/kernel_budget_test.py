# SPDX-License-Identifier: BSD-3-Clause
"""tools/kernel_budget.py names kernels that grow, refuses instructions with free rounding, skips unchanged files."""
import os
import subprocess
import sys
import unittest

from tree import ROOT, Tree

sys.path.insert(0, str(ROOT / "tools"))
import kernel_budget  # noqa: E402

# strided_kernel<Local, Draw> of rastrum::parallel::cuda_system::on_gpu, as nvcc names it.
STRIDED = "_ZN7rastrum8parallel11cuda_system6on_gpu14strided_kernelI5Local4DrawEEvNS0_9LoopCountET0_"
THRUST = "_ZN6thrust4core13_kernel_agentIiEEvT_"
LOG = """ptxas info    : Compiling entry function '{thrust}' for 'sm_90'
ptxas info    : Function properties for {thrust}
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 255 registers
ptxas info    : Compiling entry function '{ours}' for 'sm_90'
ptxas info    : Function properties for {ours}
    {stack} bytes stack frame, 4 bytes spill stores, 8 bytes spill loads
ptxas info    : Used {registers} registers, used 1 barriers
"""
PTX = "\t{ftz}mul.rn.f32 \t%f1, %f2, %f3;\n\t@%p1 mad.lo.s32 \t%r1, %r2, %r3, %r4;\n\tdiv.rn.f64 \t%fd1, %fd2, %fd3;\n"


class Instructions(unittest.TestCase):
    def of(self, line):
        return kernel_budget.instructions_of(line + "\n")[1]

    def test_what_rounds_freely(self):
        for name in ("fma.rn.f32", "fma.rn.ftz.f32", "fma.rn.f64", "mad.rn.f32", "fma.rn.f16x2", "mul.ftz.f32",
                     "ex2.approx.f32", "rcp.approx.ftz.f64", "div.approx.f32", "cvt.ftz.f32.f16"):
            self.assertEqual(self.of(f"\t{name} \t%f1, %f2;"), {name: 1})
            self.assertEqual(self.of(f"\t@!%p12 {name} \t%f1, %f2;"), {name: 1})

    def test_what_rounds_in_one_way(self):
        for line in ("mad.lo.s32 %r1;", "mad.wide.u32 %rd1;", "mad.hi.u64 %rd1;", "mul.rn.f32 %f1;", "sqrt.rn.f64 %fd1;",
                     "cvt.rzi.s32.f32 %r1;", "// fma.rn.f32", ".reg .f32 %fma<3>;", "call.uni no_fma.approx, (x);"):
            self.assertEqual(self.of(f"\t{line}"), {})

    def test_floats_are_counted(self):
        self.assertEqual(kernel_budget.instructions_of(PTX.format(ftz="")), (2, {}))


class Budget(Tree):
    def setUp(self):
        super().setUp()
        self.write("cmake/RastrumCuda.cmake", "set(cuda_flags --fmad=false\n  -Werror=all-warnings)\n")
        self.write("rastrum/draw.cu", "int first;\n")
        self.write("tests/words.cu", "int words;\n")
        (self.root / "tests/cuda").mkdir()
        self.gives()

    def gives(self, registers=60, stack=72, code=0x400, ftz=""):
        """Writes stand-ins of the tools, which give these answers and log each call."""
        self.write("k.ptx", PTX.format(ftz=ftz))
        self.write("k.log", LOG.format(ours=STRIDED, thrust=THRUST, registers=registers, stack=stack))
        self.write("k.elf", f"  [ 5] .text.{STRIDED} PROGBITS 000 000 {code:06x} 00 AX 0 0 128\n")
        for tool, does in (("nvcc", 'while [[ $# -gt 1 && $1 != -o ]]; do shift; done; [[ $# -lt 2 ]] || '
                                    f'cp {self.root}/k.ptx $2'),
                           ("ptxas", f"cat {self.root}/k.log"), ("readelf", f"cat {self.root}/k.elf")):
            self.write_script(f"bin/{tool}", f'echo "{tool} $*" >> {self.root}/calls\n{does}\n')
        self.write("calls", "")

    def budget(self, *arguments):
        run = subprocess.run([sys.executable, ROOT / "tools/kernel_budget.py", *arguments, self.root], text=True,
                             capture_output=True, env={**os.environ, "PATH": f"{self.root}/bin:{os.environ['PATH']}"})
        self.assertEqual(run.stderr, "")
        return run.returncode, run.stdout

    def compilations(self):
        calls = (self.root / "calls").read_text().splitlines()
        self.write("calls", "")
        for call in calls:
            self.assertNotIn("-Werror", call)
        return sum("-ptx" in call and "--fmad=false" in call for call in calls)

    def forget(self):
        """Simulates a fresh checkout: it has the record but no results of compilations."""
        for file in (self.root / "build/budget").iterdir():
            file.unlink()

    def record(self):
        self.assertEqual(self.budget("record")[0], 0)
        return (self.root / "tests/cuda/kernels.txt").read_text()

    def test_record_names_our_kernels(self):
        text = self.record()
        self.assertIn("60 72 4 1024\trastrum/draw.cu: strided_kernel<Local, Draw>\n", text)
        self.assertNotIn("thrust", text)
        self.assertIn("## tests/words.cu ", text)
        self.assertEqual(self.compilations(), 2)

    def test_what_is_as_it_was_is_not_compiled(self):
        before = self.record()
        self.compilations()
        self.forget()
        self.assertEqual(self.budget("check")[0], 0)
        self.assertEqual(self.record(), before)
        self.assertEqual(self.compilations(), 0)
        self.write("rastrum/draw.cu", "int second;\n")
        self.assertEqual(self.budget("check")[0], 0)
        self.assertEqual(self.compilations(), 1)
        # The check's results become the record's.
        self.assertNotEqual(self.record(), before)
        self.assertEqual(self.compilations(), 0)
        self.forget()
        self.assertEqual(self.budget("check", "all")[0], 0)
        self.assertEqual(self.compilations(), 2)

    def test_what_grows_is_named(self):
        self.record()
        for figures, says in (({"registers": 64}, "60 → 64 registers"), ({"stack": 80}, "72 → 80 bytes of stack"),
                              ({"code": 0x480}, "1024 → 1152 bytes of code")):
            self.write("rastrum/draw.cu", f"int {next(iter(figures))};\n")
            self.gives(**figures)
            self.assert_says(self.budget("check"), f"rastrum/draw.cu: strided_kernel<Local, Draw>: {says}\n")

    def test_what_shrinks_is_named_and_right(self):
        self.record()
        self.write("rastrum/draw.cu", "int less;\n")
        self.gives(registers=40, code=0x410)
        self.assert_says(self.budget("check"), "60 → 40 registers, 1024 → 1040 bytes of code", code=0)

    def test_new_kernels_and_those_that_go(self):
        self.record()
        (self.root / "rastrum/draw.cu").rename(self.root / "rastrum/other.cu")
        self.assert_says(self.budget("check"), "rastrum/other.cu: strided_kernel<Local, Draw>: is new, 60 registers",
                         "rastrum/draw.cu: strided_kernel<Local, Draw>: is gone")

    def test_what_rounds_freely_is_not_recorded(self):
        before = self.record()
        self.write("tests/words.cu", "int fma;\n")
        self.gives(ftz="mul.ftz.f32 %f4, %f5, %f6;\n\t")
        for command in ("check", "record"):
            self.assert_says(self.budget(command), "tests/words.cu: PTX has 1 × mul.ftz.f32\n")
        self.assertEqual((self.root / "tests/cuda/kernels.txt").read_text(), before)


if __name__ == "__main__":
    unittest.main()
