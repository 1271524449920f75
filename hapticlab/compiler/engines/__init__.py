"""What executes a program: engines that give the same bits in float32, as long as all numbers are finite.

In: a ``Program`` and arrays of inputs. Out: arrays of outputs and states.
Read ``engine`` (the contract), ``table`` (which there are, and which is chosen) and ``interpreter`` (the reference);
``llvm``, ``llvm_emit`` and ``side_by_side`` (machine code), ``skipped_arms`` and ``llvm_branches`` (what only one case
needs); ``wasm`` and ``wasm_emit`` (WebAssembly), ``wasm_code``, ``wasm_module`` and ``wasm_words`` (its code, its file, its
instructions); ``bytecode``, ``vm`` and ``firmware_library`` (the board's own code on this computer, built by
``toolchain``).
"""
