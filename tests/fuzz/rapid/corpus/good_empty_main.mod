MODULE M
  PROC main()
    ! nothing
  ENDPROC
ENDMODULE
