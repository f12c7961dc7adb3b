"""The pages of the Python package; every block is executed when they are built."""

import tltl

project = "tltl"
version = release = tltl.__version__
extensions = ["myst_nb", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = "tltl for Python"
exclude_patterns = ["_build"]
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
myst_enable_extensions = ["colon_fence"]
# In the documentation of functions, as in the sources in Rust, `…` is code.
default_role = "literal"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
# They are large, and the reference needs none of what they do.
autodoc_mock_imports = ["minari", "ray", "stable_baselines3", "torch"]
