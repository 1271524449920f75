"""`hapticlab doctor --self-test`: what works on this computer, found by trying it, in one file to send.

A check is a function in `computer`, `file_checks`, `running` or `teaching`, and a row of `table.CHECKS`. `all_checks`
starts each in a Python of its own with a limit of time (`python -m hapticlab.self_test FUNCTION FILE`), so that neither
a crash nor a hang ends the others. `report` makes the file, without the names of the user and of the computer.
"""
