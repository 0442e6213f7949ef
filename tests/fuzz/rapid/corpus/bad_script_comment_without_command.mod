MODULE M
  ! %DRAW_SCENE
  PROC main()
    !%
    ! %  ;
  ENDPROC
ENDMODULE
