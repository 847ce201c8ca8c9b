"""The package as `colcon build` installs it."""

from setuptools import setup

setup(
    name="esplanade_ros",
    version="0.1.0",
    packages=["esplanade_ros"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/esplanade_ros"]),
        ("share/esplanade_ros", ["package.xml"]),
    ],
    install_requires=["setuptools", "esplanade"],
    zip_safe=True,
    entry_points={"console_scripts": ["bridge = esplanade_ros.node:main"]},
)
