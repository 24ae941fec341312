"""The garbage collector goes over what thousands of tests hold less often, which takes a twelfth of
their time otherwise.
"""

import gc

gc.set_threshold(100_000, 20, 20)
