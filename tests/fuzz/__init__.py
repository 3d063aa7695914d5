"""Fuzzing of everything that reads a stranger's file: `make fuzz`, and the share of it that runs in every test.

`*.cpp` are libFuzzer targets for the compiled mesh readers, built with the sanitizers of addresses and of undefined
behaviour. `readers` lists the readers that Python sees; `child` damages their files in a process of its own, which may
crash, hang or run out of memory without ending the others. `seeds` makes the files that both start from.
"""
