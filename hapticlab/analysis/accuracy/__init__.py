"""Speed against accuracy: the error of each method, its cost, and the choice between them.

In: a scene, a paddle or a motion of the handle. Out: rows of settings with force errors and costs, and plots of them.
Read ``handle_motions`` and ``reference`` (what is true; ``reference_plot`` draws it), ``port_error``, then ``tradeoff``
with ``tradeoff_setup``, ``tradeoff_trials``, ``tradeoff_search``, ``tradeoff_rows``, ``tradeoff_choice`` and
``tradeoff_sentences``; ``work_precision``; ``hybrid_solver``, ``continuous_handle`` and ``accelerations_at`` are the
second opinion that shares no stepping with the compiler.
"""
