# Not needed where the plug-in is installed.
pytest_plugins = ["pytest_s7200"]
