# The command `pantograph` with everything it needs, from Debian's packages alone.
#
#   docker build -t pantograph_fem .
#   mkdir -p results
#   docker run --rm --user "$(id -u)" -v "$PWD/cases:/cases:ro" -v "$PWD/results:/results" \
#       pantograph_fem run /cases/a_bias_extension.toml
FROM debian:trixie-slim

COPY apt-packages.txt /tmp/
# Beyond the shared list: the Python libraries that a development set-up takes from PyPI.
RUN apt-get update \
 && sed 's/#.*//' /tmp/apt-packages.txt \
    | xargs apt-get install -y --no-install-recommends \
        python3-jinja2 python3-matplotlib python3-meshio python3-pydantic python3-rich \
        python3-setuptools python3-tomli-w python3-typer \
 && apt-get clean \
 && rm -rf /var/lib/apt/lists/* /tmp/apt-packages.txt

COPY pyproject.toml README.md /opt/pantograph_fem/
COPY pantograph_fem /opt/pantograph_fem/pantograph_fem
COPY cases /opt/pantograph_fem/cases
COPY meshes /opt/pantograph_fem/meshes
COPY studies /opt/pantograph_fem/studies
RUN printf '#!/bin/sh\nexec python3 -m pantograph_fem "$@"\n' > /usr/local/bin/pantograph \
 && chmod 755 /usr/local/bin/pantograph

# Compiled forms and figures' font caches must be writable by any user that the container runs as.
ENV PYTHONPATH=/opt/pantograph_fem \
    XDG_CACHE_HOME=/tmp/cache \
    MPLCONFIGDIR=/tmp/cache/matplotlib \
    OMP_NUM_THREADS=1 \
    OPENBLAS_NUM_THREADS=1
RUN useradd --create-home pantograph && mkdir -m 777 /results
USER pantograph
# Results go to /results/<name>: `results/` of this folder.
WORKDIR /
ENTRYPOINT ["pantograph"]
CMD ["--help"]
