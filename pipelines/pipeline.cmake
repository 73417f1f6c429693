# A pipeline is pure computation on values. These are all the libraries that one may link; DDS,
# SQLite, threads, logging and the services are refused when CMake configures.
set_property(GLOBAL PROPERTY SPINDRIFT_PIPELINE_MAY_LINK
  Boost::headers Ceres::ceres Eigen3::Eigen fmt::fmt PkgConfig::ERFA tl::expected)

# spindrift_pipeline(FOLDER ...): spindrift_library() under that rule.
function(spindrift_pipeline name)
  spindrift_library(${name} ${ARGN})
  set_property(GLOBAL APPEND PROPERTY SPINDRIFT_PIPELINES ${name})
endfunction()

# Looks at what every pipeline links in the end, however it came to.
function(spindrift_check_pipelines)
  get_property(pipelines GLOBAL PROPERTY SPINDRIFT_PIPELINES)
  get_property(libraries GLOBAL PROPERTY SPINDRIFT_PIPELINE_MAY_LINK)
  set(allowed ${libraries} spindrift_options)
  foreach(name IN LISTS pipelines)
    list(APPEND allowed spindrift::${name} spindrift_${name})
  endforeach()
  foreach(name IN LISTS pipelines)
    set(links "")
    foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
      get_target_property(value spindrift_${name} ${property})
      if(value)
        list(APPEND links ${value})
      endif()
    endforeach()
    list(TRANSFORM links REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1")
    list(REMOVE_DUPLICATES links)
    foreach(link IN LISTS links)
      if(NOT link IN_LIST allowed)
        message(SEND_ERROR
          "The pipeline '${name}' links ${link}. A pipeline may link other pipelines and "
          "${libraries}; what touches the world belongs to services/.")
      endif()
    endforeach()
  endforeach()
endfunction()
